#include "grammar/operations/plan_edges.h"

namespace sgm::operations {
namespace {

bool holdsWord(std::string_view tag, std::string_view word) {
    while (!tag.empty()) {
        const size_t end = std::min(tag.find(' '), tag.size());
        if (tag.substr(0, end) == word) return true;
        tag.remove_prefix(std::min(end + 1, tag.size()));
    }
    return false;
}

}  // namespace

bool isEdgeCalled(const plan::Footprint& footprint, const plan::PlacedEdge& edge, std::string_view word) {
    if (word == "side" || word == "rest") return true;
    if (word == "court" && edge.edge.source == plan::EdgeSource::Court) return true;
    if (word == "cut") return edge.edge.source == plan::EdgeSource::Cut;
    const bool ofCourt = edge.edge.source == plan::EdgeSource::Court;
    const plan::Facing facing = plan::facingOf(edge.normal());
    if (word == "front") return !ofCourt && facing == plan::Facing::Front;
    if (word == "back") return !ofCourt && facing == plan::Facing::Back;
    if (word == "left") return !ofCourt && facing == plan::Facing::Left;
    if (word == "right") return !ofCourt && facing == plan::Facing::Right;
    return holdsWord(footprint.tags[edge.edge.tag], word);
}

}  // namespace sgm::operations
