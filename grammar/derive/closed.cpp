// Which shapes closed the joints that newcomers asked for.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/derive.h"
#include "grammar/derive/support.h"

namespace sgm::derive {
namespace {

/// The shape on the other side of a bond from a joint's own place; none where both ends were one place.
ShapeId partnerIn(const Bonds& bonds, const Bond& bond, ShapeId host) {
    for (const ShapeId end : bond.shape)
        if (bonds.bodyOf[end] != bonds.bodyOf[host]) return end;
    return none;
}

}  // namespace

std::string closedBy(const Derivation& derivation, const Closed& closed) {
    constexpr size_t most = 3;
    if (closed.host == none) return "";
    const ShapeTree& tree = derivation.tree;
    const Bonds& bonds = tree.bonds();
    std::string text;
    for (size_t i = 0; i < std::min(most, closed.joints.size()); ++i) {
        const uint32_t joint = closed.joints[i], index = bonds.at(closed.host, joint);
        const ShapeId partner = index == none ? none : partnerIn(bonds, bonds.all[index], closed.host);
        if (partner == none) continue;  // what met it was replaced since
        if (!text.empty()) text += ", ";
        text += fmt::format("'{}' of '{}' is {} {}", tree.joint(closed.host, joint).name, tree.path(closed.host),
                            bonds.all[index].directed ? "closed by" : "bonded to", madeBy(derivation, partner));
    }
    return text + (text.empty() || closed.joints.size() <= most ? "" : " …");
}

std::string closedBy(const Derivation& derivation, const std::vector<Closed>& closed) {
    std::vector<std::string> texts;
    for (const Closed& one : closed)
        if (std::string text = closedBy(derivation, one);
            !text.empty() && std::find(texts.begin(), texts.end(), text) == texts.end())
            texts.push_back(std::move(text));
    return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace sgm::derive
