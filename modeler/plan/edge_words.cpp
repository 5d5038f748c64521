#include "modeler/plan/edge_words.h"

#include <algorithm>

namespace sgm::plan {
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

bool isCommonEdgeWord(std::string_view word) {
    return std::find(std::begin(commonEdgeWords), std::end(commonEdgeWords), word) != std::end(commonEdgeWords);
}

bool isEdgeCalled(const Footprint& footprint, const PlacedEdge& edge, std::string_view word) {
    if (word == "side" || word == "rest") return true;
    if (word == "court" && edge.edge.source == EdgeSource::Court) return true;
    if (word == "cut") return edge.edge.source == EdgeSource::Cut;
    const bool ofCourt = edge.edge.source == EdgeSource::Court;
    const Facing facing = facingOf(edge.normal());
    if (word == "front") return !ofCourt && facing == Facing::Front;
    if (word == "back") return !ofCourt && facing == Facing::Back;
    if (word == "left") return !ofCourt && facing == Facing::Left;
    if (word == "right") return !ofCourt && facing == Facing::Right;
    return holdsWord(footprint.tags[edge.edge.tag], word);
}

std::vector<std::string> edgeWords(const Footprint& footprint, const PlacedEdge& edge) {
    std::vector<std::string> words;
    for (const char* word : {"front", "back", "left", "right", "court", "cut"})
        if (isEdgeCalled(footprint, edge, word)) words.emplace_back(word);
    std::string_view tag = footprint.tags[edge.edge.tag];
    while (!tag.empty()) {
        const size_t end = std::min(tag.find(' '), tag.size());
        const std::string word(tag.substr(0, end));
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
        tag.remove_prefix(std::min(end + 1, tag.size()));
    }
    return words;
}

}  // namespace sgm::plan
