// Figures of a derivation for `check … expect`: overlapping boxes.
#include <algorithm>
#include <unordered_set>

#include "grammar/derive/boxes.h"
#include "grammar/derive/derive.h"

namespace sgm::derive {
namespace {

/// Counting ends there: shapes that all stand at one place overlap in as many pairs as there are.
constexpr uint64_t mostOverlaps = 1'000'000;

/// Places that a bond joins, as unordered pairs.
std::unordered_set<uint64_t> bondedPlaces(const Bonds& bonds) {
    std::unordered_set<uint64_t> pairs;
    for (const Bond& b : bonds.all) {
        const auto [lo, hi] = std::minmax(bonds.bodyOf[b.shape[0]], bonds.bodyOf[b.shape[1]]);
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
        if (const ShapeId parent = tree.shapes[*it].parent; parent != none)
            out[parent].second = std::max(out[parent].second, out[*it].second);
    return out;
}

}  // namespace

uint64_t Derivation::terminals() const {
    return static_cast<uint64_t>(
        std::count_if(tree.shapes.begin(), tree.shapes.end(), [](const Shape& s) { return s.solid != none; }));
}

void Reported::add(const Reported& other) {
    if (other.count == 0) return;
    least = count == 0 ? other.least : std::min(least, other.least);
    greatest = count == 0 ? other.greatest : std::max(greatest, other.greatest);
    sum += other.sum;
    count += other.count;
}

Reported Derivation::reported(uint32_t report) const {
    Reported r;
    for (ShapeId s = tree.shapes.empty() ? none : 0; s != none; s = tree.next(s)) {
        const Extras* extras = tree.extrasOf(s);
        if (!extras) continue;
        for (const auto& [index, value] : extras->reports) {
            if (index == report) r.add(value);
        }
    }
    return r;
}

uint64_t Derivation::overlaps() const {
    const Bonds& bonds = tree.bonds();
    const auto bonded = bondedPlaces(bonds);
    const auto spans = intervals(tree);
    const auto above = [&](ShapeId a, ShapeId b) {
        return spans[a].first <= spans[b].first && spans[b].first <= spans[a].second;
    };
    uint64_t count = 0;
    forPairs(tree, 0, [&](ShapeId a, ShapeId b) {
        const Shape &p = tree.shapes[a], &q = tree.shapes[b];
        const uint32_t mine = bonds.bodyOf[a], theirs = bonds.bodyOf[b];
        if (mine == theirs || above(a, b) || above(b, a)) return true;
        if (penetration(p.scope, q.scope) <= boxSlack_m) return true;
        const auto [lo, hi] = std::minmax(mine, theirs);
        count += !bonded.contains(uint64_t(lo) << 32 | hi);
        return count < mostOverlaps;
    });
    return count;
}

}  // namespace sgm::derive
