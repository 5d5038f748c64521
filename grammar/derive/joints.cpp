#include "grammar/derive/joints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "modeler/core/conventions.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

constexpr double cell_m = 32 * jointTolerance_m;  // wide, so that few joints stand near a cell's border
constexpr double cosineTolerance = 1e-9;

bool directed(Vec3d d) { return d != Vec3d{}; }

/// Joints of one direction begin at one slot and those that look the other way at its neighbour, in the same cache
/// line.
uint64_t cellHash(int64_t x, int64_t y, int64_t z, Vec3d direction) {
    const auto coarse = [](double d) {
        return std::abs(d) < 2 ? static_cast<int64_t>(d * 4 + std::copysign(0.5, d)) : int64_t{8};
    };
    int64_t looks = coarse(direction.x) * 289 + coarse(direction.y) * 17 + coarse(direction.z);
    const bool flipped = looks < 0;
    if (flipped) looks = -looks;
    const uint64_t h =
        mix(static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ull ^ static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4full ^
            static_cast<uint64_t>(z) * 0x165667b19e3779f9ull ^ static_cast<uint64_t>(looks));
    return (h & ~uint64_t{1}) | (flipped ? 1 : 0);
}

/// The hash of the same cell for the opposite direction.
uint64_t opposite(uint64_t cell) { return cell ^ 1; }

/// The outermost cells hold all that is farther away than any model reaches.
int64_t cellOf(double v) {
    constexpr double farthest = 1e15;
    const double cell = std::clamp(std::floor(v / cell_m), -farthest, farthest);
    return std::isnan(cell) ? 0 : static_cast<int64_t>(cell);
}

/// Calls f with the cells within tolerance of p: one nearly always, up to eight at a corner.
template <class F>
void forCells(Vec3d p, Vec3d direction, F f) {
    int64_t lo[3], hi[3];
    for (int i = 0; i < 3; ++i) {
        lo[i] = cellOf(p[i] - jointTolerance_m);
        hi[i] = cellOf(p[i] + jointTolerance_m);
    }
    for (int64_t x = lo[0]; x <= hi[0]; ++x)
        for (int64_t y = lo[1]; y <= hi[1]; ++y)
            for (int64_t z = lo[2]; z <= hi[2]; ++z) f(cellHash(x, y, z, direction));
}

/// Round coordinates, where most joints stand, then lie well within a cell, and forCells looks at one.
Vec3d offset(Vec3d p) { return p + Vec3d{cell_m, cell_m, cell_m} * 0.43; }

/// The smallest rotation that takes unit a to unit b; half a turn goes about `up` where it can.
Mat3 turnTo(Vec3d a, Vec3d b, const Mat3& axes) {
    const double c = dot(a, b);
    if (c > 1 - cosineTolerance) return {};
    if (c > -1 + cosineTolerance) return Mat3::rotation(cross(a, b), std::acos(c));
    const Vec3d axis = std::abs(dot(axes.y, a)) < 0.5 ? axes.y : axes.x;
    return Mat3::rotation(axis - a * dot(axis, a), pi);
}

/// Half the length of the box along `direction`.
double reach(const Mat3& axes, Vec3d size, Vec3d direction) {
    return 0.5 * (std::abs(dot(axes.x, direction)) * size.x + std::abs(dot(axes.y, direction)) * size.y +
                  std::abs(dot(axes.z, direction)) * size.z);
}

}  // namespace

uint32_t faceLookingBack(const ShapeTree& tree, const Mate& mate) {
    const Joint ours = tree.joint(mate.host, mate.ours);
    if (!isDirected(ours) || isDirected(tree.joint(mate.newcomer, mate.theirs))) return none;
    const uint32_t back = opposedFace(tree.shapes.axesOf(mate.newcomer), ours.direction);
    return dot(tree.joint(mate.newcomer, back).direction, ours.direction) < -0.999 ? back : none;
}

bool faceEachOther(const Joint& a, const Joint& b) {
    if (!directed(a.direction) || !directed(b.direction)) return false;
    const Vec3d gap = a.point - b.point;
    return dot(gap, gap) <= jointTolerance_m * jointTolerance_m && dot(a.direction, b.direction) < -1 + 1e-6;
}

void JointIndex::search(const ShapeTree& tree, uint64_t cell, const Joint& joint, std::optional<Entry>& newest) const {
    const size_t mask = slots_.size() - 1;
    for (size_t i = cell & mask; slots_[i].entry.shape != none; i = (i + 1) & mask) {
        const auto [key, entry] = slots_[i];
        if (key != cell || tree.shapes[entry.shape].dead) continue;
        if (newest && std::pair(entry.shape, entry.joint) < std::pair(newest->shape, newest->joint)) continue;
        if (faceEachOther(joint, tree.joint(entry.shape, entry.joint))) newest = entry;
    }
    if (fullCells_.empty()) return;
    const auto full = fullCells_.find(cell);
    if (full == fullCells_.end()) return;
    for (auto entry = full->second.rbegin(); entry != full->second.rend() && (!newest || *newest < *entry); ++entry)
        if (!tree.shapes[entry->shape].dead && faceEachOther(joint, tree.joint(entry->shape, entry->joint)))
            newest = *entry;
}

/// Puts an entry into a free slot; false where its cell has its share of them already.
bool JointIndex::insert(Slot slot) {
    constexpr size_t most = 16;
    const size_t mask = slots_.size() - 1;
    size_t i = slot.cell & mask, ofCell = 0;
    for (; slots_[i].entry.shape != none; i = (i + 1) & mask)
        if (slots_[i].cell == slot.cell && ++ofCell == most) return false;
    slots_[i] = slot;
    return true;
}

void JointIndex::enter(Slot slot) {
    if ((used_ + 1) * 2 > slots_.size()) grow();
    if (insert(slot))
        ++used_;
    else
        inFullCells_ += fullCells_[slot.cell].insert(slot.entry).second;
}

void JointIndex::grow() {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
    for (const Slot& slot : old)
        if (slot.entry.shape != none) insert(slot);
}

JointIndex::Spot JointIndex::expect(const Joint& joint) const {
    const Vec3d p = offset(joint.point);
    const int64_t x = cellOf(p.x), y = cellOf(p.y), z = cellOf(p.z);
    const auto inside = [](double v, int64_t cell) {
        return cellOf(v - jointTolerance_m) == cell && cellOf(v + jointTolerance_m) == cell;
    };
    const Spot spot{cellHash(x, y, z, joint.direction), inside(p.x, x) && inside(p.y, y) && inside(p.z, z)};
    __builtin_prefetch(&slots_[spot.cell & (slots_.size() - 1)]);
    return spot;
}

std::optional<JointIndex::Entry> JointIndex::facing(const ShapeTree& tree, const Joint& joint, Spot spot) const {
    std::optional<Entry> partner;
    if (spot.inside)
        search(tree, opposite(spot.cell), joint, partner);
    else
        forCells(offset(joint.point), -joint.direction, [&](uint64_t cell) { search(tree, cell, joint, partner); });
    return partner;
}

std::optional<JointIndex::Entry> JointIndex::newestFacing(const ShapeTree& tree, const Joint& joint) const {
    return facing(tree, joint, expect(joint));
}

std::optional<JointIndex::Entry> JointIndex::add(const ShapeTree& tree, Entry entry, const Joint& joint, Spot spot) {
    const auto partner = facing(tree, joint, spot);
    enter({spot.cell, entry});
    return partner;
}

void JointIndex::move(Entry entry, Spot spot) {
    const size_t mask = slots_.size() - 1;
    for (size_t i = spot.cell & mask; slots_[i].entry.shape != none; i = (i + 1) & mask)
        if (slots_[i].cell == spot.cell && slots_[i].entry == entry) return;
    enter({spot.cell, entry});
}

std::vector<uint64_t> JointIndex::cellsFacing(const Joint& joint) {
    std::vector<uint64_t> cells;
    forCells(offset(joint.point), -joint.direction, [&](uint64_t cell) { cells.push_back(cell); });
    return cells;
}

std::optional<JointIndex::Entry> JointIndex::partner(const ShapeTree& tree, Entry entry, const Joint& joint) const {
    std::optional<Entry> newest;
    forFacing(tree, joint, [&](Entry e) {
        if (e < entry && (!newest || *newest < e)) newest = e;
    });
    return newest;
}

uint32_t opposedFace(const Mat3& axes, Vec3d direction) {
    uint32_t best = 0;
    double least = 2;
    for (uint32_t j = 0; j < faceCount; ++j) {
        const double c = dot(axes * faceDirection(j), direction);
        if (c < least - 1e-9) least = c, best = j;
    }
    return best;
}

Scope mate(const Mating& m, const Mat3& asked, Vec3d size) {
    Scope scope{m.ours.point, asked, size};
    if (directed(m.ours.direction) && directed(m.theirs.facing))
        scope.axes = turnTo(asked * m.theirs.facing, -m.ours.direction, asked) * asked;
    const Vec3d inward = m.ours.direction * (-m.overlap * reach(scope.axes, size, m.ours.direction));
    scope.centre = m.ours.point + m.moved_m + inward - scope.axes * (m.theirs.at * scope.half());
    return scope;
}

}  // namespace sgm::derive
