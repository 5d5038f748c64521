#include "grammar/derive/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "grammar/derive/boxes.h"

namespace sgm::derive {
namespace {

/// True for shapes that add to what stands: no cutter and no mask, and not inside one.
std::vector<bool> adding(const ShapeTree& tree) {
    std::vector<bool> adds(tree.shapes.size(), true);
    for (ShapeId s = 0; s < tree.shapes.size(); ++s) {
        const Shape& shape = tree.shapes[s];
        if (shape.op == rules::Operator::Difference || shape.op == rules::Operator::Intersection) adds[s] = false;
        if (shape.parent != none && !adds[shape.parent]) adds[s] = false;
    }
    return adds;
}

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t s) {
    while (parent[s] != s) s = parent[s] = parent[parent[s]];
    return s;
}

}  // namespace

std::vector<uint32_t> touchingGroups(const ShapeTree& tree) {
    const std::vector<bool> adds = adding(tree);
    std::vector<uint32_t> parent(tree.shapes.size());
    std::iota(parent.begin(), parent.end(), 0u);
    forPairs(tree, boxSlack_m, [&](ShapeId a, ShapeId b) {
        if (!adds[a] || !adds[b] || rootOf(parent, a) == rootOf(parent, b)) return true;
        if (penetration(outerScope(tree, a), outerScope(tree, b)) >= -boxSlack_m)
            parent[rootOf(parent, a)] = rootOf(parent, b);
        return true;
    });
    std::vector<uint32_t> groupOf(tree.shapes.size(), none), number(tree.shapes.size(), none);
    uint32_t count = 0;
    for (ShapeId s = 0; s != none; s = tree.next(s)) {
        if (tree.shapes[s].solid == none || !adds[s]) continue;
        uint32_t& n = number[rootOf(parent, s)];
        if (n == none) n = count++;
        groupOf[s] = n;
    }
    return groupOf;
}

std::vector<bool> floatingGroups(const ShapeTree& tree, std::span<const uint32_t> groupOf) {
    std::vector<double> foot;
    for (ShapeId s = 0; s < tree.shapes.size(); ++s) {
        if (groupOf[s] == none) continue;
        if (foot.size() <= groupOf[s]) foot.resize(groupOf[s] + 1, 1e300);
        const Scope& scope = tree.shapes[s].scope;
        foot[groupOf[s]] = std::min(foot[groupOf[s]], scope.centre.y - reach(scope, {0, 1, 0}));
    }
    std::vector<bool> floats(foot.size());
    if (foot.empty()) return floats;
    const double ground = *std::min_element(foot.begin(), foot.end());
    for (size_t g = 1; g < foot.size(); ++g) floats[g] = foot[g] > ground + boxSlack_m;
    return floats;
}

ShapeId beginOf(const ShapeTree& tree, std::span<const uint32_t> groupOf, uint32_t group) {
    // Children come after their parents, so one sweep back tells every shape what it holds.
    std::vector<uint32_t> holds(groupOf.begin(), groupOf.end());
    for (ShapeId s = static_cast<ShapeId>(tree.shapes.size()); s-- > 1;) {
        uint32_t& above = holds[tree.shapes[s].parent];
        if (holds[s] != none && above != holds[s]) above = above == none ? holds[s] : mixedGroups;
    }
    for (ShapeId s = 0; s != none; s = tree.next(s))
        if (holds[s] == group) return s;
    const auto first = std::find(groupOf.begin(), groupOf.end(), group);
    return first == groupOf.end() ? none : static_cast<ShapeId>(first - groupOf.begin());
}

std::string madeBy(const Derivation& d, ShapeId id) {
    const Shape& s = d.tree.shapes[id];
    std::string text = fmt::format("'{}', made by ", d.tree.path(id));
    text += s.madeBy == none ? std::string("the start")
                             : fmt::format("rule '{}'", d.grammar->rules[d.steps[s.madeBy].rule].name);
    if (s.span.source) text += fmt::format(" ({}:{})", s.span.source->name(), s.span.source->place(s.span.begin).line);
    return text;
}

uint64_t Derivation::floating() const {
    const auto groupOf = touchingGroups(tree);
    const auto floats = floatingGroups(tree, groupOf);
    return static_cast<uint64_t>(
        std::count_if(groupOf.begin(), groupOf.end(), [&](uint32_t g) { return g != none && floats[g]; }));
}

std::vector<ShapeId> Derivation::floatingShapes() const {
    const auto groupOf = touchingGroups(tree);
    const auto floats = floatingGroups(tree, groupOf);
    std::vector<ShapeId> shapes;
    for (uint32_t g = 0; g < floats.size(); ++g)
        if (floats[g]) shapes.push_back(beginOf(tree, groupOf, g));
    return shapes;
}

}  // namespace sgm::derive
