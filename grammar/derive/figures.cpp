// What `check … expect` asks of a derivation: overlapping boxes, floating solids.
#include <algorithm>
#include <numeric>
#include <unordered_set>

#include "grammar/derive/derive.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

constexpr double slack_m = 1e-4;  // boxes that meet by less only touch

/// A solid's box and its extent along x, for the sweep.
struct Boxed {
    double lo, hi;
    ShapeId shape;
};

double reach(const Scope& s, Vec3d axis) {
    const Vec3d h = s.half();
    return std::abs(dot(s.axes.x, axis)) * h.x + std::abs(dot(s.axes.y, axis)) * h.y + std::abs(dot(s.axes.z, axis)) * h.z;
}

bool isUpright(const Scope& s) { return s.axes == Mat3{}; }

/// The depth by which two oriented boxes overlap (separating axes); negative when they are apart.
double penetration(const Scope& a, const Scope& b) {
    const Vec3d gap = b.centre - a.centre;
    double least = 1e300;
    const auto along = [&](Vec3d axis) {
        const double l = length(axis);
        if (l < 1e-6) return;
        axis = axis / l;
        least = std::min(least, reach(a, axis) + reach(b, axis) - std::abs(dot(gap, axis)));
    };
    const Vec3d axesA[3] = {a.axes.x, a.axes.y, a.axes.z}, axesB[3] = {b.axes.x, b.axes.y, b.axes.z};
    for (int i = 0; i < 3; ++i) along(axesA[i]);
    if (isUpright(a) && isUpright(b)) return least;
    for (int i = 0; i < 3; ++i) along(axesB[i]);
    for (const Vec3d& u : axesA)
        for (const Vec3d& v : axesB) along(cross(u, v));
    return least;
}

std::vector<Boxed> solidsByX(const ShapeTree& tree) {
    std::vector<Boxed> boxes;
    for (ShapeId s = 0; s < tree.shapes.size(); ++s) {
        if (tree.shapes[s].solid == none) continue;
        const Scope& scope = tree.shapes[s].scope;
        const double r = reach(scope, {1, 0, 0});
        boxes.push_back({scope.centre.x - r, scope.centre.x + r, s});
    }
    std::sort(boxes.begin(), boxes.end(), [](const Boxed& a, const Boxed& b) { return a.lo != b.lo ? a.lo < b.lo : a.shape < b.shape; });
    return boxes;
}

/// Calls f(a, b) for every pair of solids whose extents along x share more than −margin.
template <class F>
void forPairs(const ShapeTree& tree, double margin, F f) {
    const auto boxes = solidsByX(tree);
    for (size_t i = 0; i < boxes.size(); ++i)
        for (size_t k = i + 1; k < boxes.size() && boxes[k].lo <= boxes[i].hi + margin; ++k) f(boxes[i].shape, boxes[k].shape);
}

/// Places that a bond joins, as unordered pairs.
std::unordered_set<uint64_t> bondedPlaces(const ShapeTree& tree) {
    std::unordered_set<uint64_t> pairs;
    for (const Bond& b : tree.bonds) {
        const auto [lo, hi] = std::minmax(tree.shapes[b.shape[0]].body, tree.shapes[b.shape[1]].body);
        pairs.insert(uint64_t(lo) << 32 | hi);
    }
    return pairs;
}

/// Position in tree order and the end of the subtree, for asking who stands above whom.
std::vector<std::pair<uint32_t, uint32_t>> intervals(const ShapeTree& tree) {
    std::vector<std::pair<uint32_t, uint32_t>> out(tree.shapes.size());
    std::vector<ShapeId> order;
    for (ShapeId s = 0; s != none; s = tree.next(s)) {
        out[s].first = out[s].second = static_cast<uint32_t>(order.size());
        order.push_back(s);
    }
    for (auto it = order.rbegin(); it != order.rend(); ++it)
        if (const ShapeId parent = tree.shapes[*it].parent; parent != none) out[parent].second = std::max(out[parent].second, out[*it].second);
    return out;
}

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t s) {
    while (parent[s] != s) s = parent[s] = parent[parent[s]];
    return s;
}

}  // namespace

uint64_t Derivation::terminals() const {
    return static_cast<uint64_t>(std::count_if(tree.shapes.begin(), tree.shapes.end(), [](const Shape& s) { return s.solid != none; }));
}

uint64_t Derivation::overlaps() const {
    const auto bonded = bondedPlaces(tree);
    const auto spans = intervals(tree);
    const auto above = [&](ShapeId a, ShapeId b) { return spans[a].first <= spans[b].first && spans[b].first <= spans[a].second; };
    uint64_t count = 0;
    forPairs(tree, 0, [&](ShapeId a, ShapeId b) {
        const Shape &p = tree.shapes[a], &q = tree.shapes[b];
        if (p.body == q.body || above(a, b) || above(b, a)) return;
        if (penetration(p.scope, q.scope) <= slack_m) return;
        const auto [lo, hi] = std::minmax(p.body, q.body);
        count += !bonded.contains(uint64_t(lo) << 32 | hi);
    });
    return count;
}

uint64_t Derivation::floating() const {
    // Union-find over places: bonds and touching boxes connect.
    std::vector<uint32_t> parent(tree.bodies.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto unite = [&](uint32_t a, uint32_t b) { parent[rootOf(parent, a)] = rootOf(parent, b); };
    for (const Bond& b : tree.bonds) unite(tree.shapes[b.shape[0]].body, tree.shapes[b.shape[1]].body);
    forPairs(tree, slack_m, [&](ShapeId a, ShapeId b) {
        const Shape &p = tree.shapes[a], &q = tree.shapes[b];
        if (rootOf(parent, p.body) != rootOf(parent, q.body) && penetration(p.scope, q.scope) >= -slack_m) unite(p.body, q.body);
    });
    uint32_t first = none;
    uint64_t count = 0;
    for (ShapeId s = 0; s != none; s = tree.next(s)) {
        if (tree.shapes[s].solid == none) continue;
        const uint32_t root = rootOf(parent, tree.shapes[s].body);
        if (first == none) first = root;
        count += root != first;
    }
    return count;
}

}  // namespace sgm::derive
