#include "grammar/derive/bonds_in_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

constexpr double sure_m = 2 * jointTolerance_m, unsure_m = 100 * jointTolerance_m;
constexpr double sureCosine = 1 - 1e-9, unsureCosine = 1 - 1e-4;

constexpr uint64_t stateBits = 3;
uint64_t keyOf(ShapeId id, uint32_t joint) { return uint64_t{id} << 32 | uint64_t{joint} << 2; }

/// Indexes the faces that came since. Several are prefetched together.
void bringUpToDate(JointIndex& index, const ShapeTree& tree, const PageArray<JointIndex::Entry>& faces,
                   size_t& indexed) {
    std::array<JointIndex::Spot, 8> spots;
    while (indexed < faces.size()) {
        const size_t count = std::min(spots.size(), faces.size() - indexed);
        for (size_t i = 0; i < count; ++i) {
            const JointIndex::Entry face = faces[indexed + i];
            spots[i] = index.expect(tree.joint(face.shape, face.joint));
        }
        for (size_t i = 0; i < count; ++i) index.put(faces[indexed + i], spots[i]);
        indexed += count;
    }
}

}  // namespace

size_t JointStates::slotOf(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    size_t i = mix(key) & mask;
    while (slots_[i] != empty && (slots_[i] & ~stateBits) != key) i = (i + 1) & mask;
    return i;
}

JointState JointStates::of(ShapeId id, uint32_t joint) const {
    const uint64_t slot = slots_[slotOf(keyOf(id, joint))];
    return slot == empty ? JointState::Open : static_cast<JointState>(slot & stateBits);
}

void JointStates::raise(ShapeId id, uint32_t joint, JointState state) {
    const uint64_t key = keyOf(id, joint);
    uint64_t& slot = slots_[slotOf(key)];
    if (slot != empty) {
        slot = key | std::max(slot & stateBits, static_cast<uint64_t>(state));
        return;
    }
    slot = key | static_cast<uint64_t>(state);
    if (2 * ++used_ <= slots_.size()) return;
    const std::vector<uint64_t> old = std::exchange(slots_, std::vector<uint64_t>(2 * slots_.size(), empty));
    for (const uint64_t known : old)
        if (known != empty) slots_[slotOf(known & ~stateBits)] = known;
}

/// A joint near two planes is unclear, so that a joint that faces one in a plane is in the same plane or unclear.
BondsInPlanes::Where BondsInPlanes::whereIs(const Joint& joint) const {
    Where where;
    for (size_t i = 0; i < planes_.size(); ++i) {
        const double cosine = dot(joint.direction, planes_[i].direction);
        const double away_m = std::abs(dot(joint.point, planes_[i].direction) - planes_[i].offset_m);
        if (std::abs(cosine) <= unsureCosine || away_m > unsure_m) continue;
        const bool isSure = std::abs(cosine) > sureCosine && away_m <= sure_m;
        if (!isSure || where.kind != Where::Kind::Away) return {Where::Kind::Unclear};
        where = {Where::Kind::In, i, cosine < 0};
    }
    return where;
}

/// Bit i: a face across axis i may lie in a plane or be unclear. O(planes), a few nanoseconds each.
uint32_t BondsInPlanes::axesThatMayMeet(const ShapeRecord& shape) const {
    constexpr double slack_m = 2 * unsure_m;
    const Vec3d half = shape.size * 0.5;
    uint32_t axes = 0;
    for (const Plane& plane : planes_) {
        const double away_m = std::abs(dot(shape.centre, plane.direction) - plane.offset_m);
        // Faces whose direction is unclear are turned by so little that their middles lie as far away, to a share.
        for (int i = 0; i < 3; ++i)
            axes |= uint32_t{std::abs(away_m - half[i]) <= slack_m + (1 - unsureCosine) * half[i]} << i;
    }
    return axes;
}

/// With another plane all shapes have to be looked at again.
void BondsInPlanes::addPlane(const Joint& joint) {
    planes_.emplace_back();
    planes_.back().direction = joint.direction;
    planes_.back().offset_m = dot(joint.point, joint.direction);
    for (Plane& plane : planes_)
        for (Side& side : plane.sides) side = {};
    states_.clear();
    next_ = 0, nextMate_ = 0;
}

/// The shape whose joint counts: a face of what fills its parent's scope is its parent's.
ShapeId BondsInPlanes::placeOf(ShapeId id, uint32_t joint) const {
    if (joint >= firstNamedJoint) return id;
    while (tree_.shapes.record(id).sharesPlace) id = tree_.shapes.record(id).parent;
    return id;
}

void BondsInPlanes::join(const Mate& m) {
    const bool areDirected = isDirected(tree_.joint(m.host, m.ours)) && isDirected(tree_.joint(m.newcomer, m.theirs));
    const JointState state = areDirected ? JointState::Closed : JointState::Bonded;
    raise({m.host, m.ours}, state);
    raise({m.newcomer, m.theirs}, state);
    if (const uint32_t back = faceLookingBack(tree_, m); back != none) raise({m.newcomer, back}, JointState::Bonded);
}

/// Closes the joint and the newest one that faces it, where both are open and not of one place.
void BondsInPlanes::arrive(Entry entry) {
    const Joint joint = tree_.joint(entry.shape, entry.joint);
    if (!isDirected(joint)) return;
    const Where where = whereIs(joint);
    isUnclear_ = isUnclear_ || where.kind == Where::Kind::Unclear;
    if (where.kind != Where::Kind::In) return;
    Side& own = planes_[where.plane].sides[where.looksBack];
    Side& other = planes_[where.plane].sides[!where.looksBack];
    if (!other.faces.empty() && stateAt(entry) != JointState::Closed) {
        bringUpToDate(other.index, tree_, other.faces, other.indexed);
        const auto partner = other.index.newestFacing(tree_, joint);
        if (partner && stateAt(*partner) != JointState::Closed &&
            placeOf(partner->shape, centreJoint) != placeOf(entry.shape, centreJoint)) {
            raise(entry, JointState::Closed);
            raise(*partner, JointState::Closed);
        }
    }
    own.faces.push_back(entry);
}

void BondsInPlanes::follow() {
    for (; next_ < tree_.shapes.size() && !isUnclear_; ++next_) {
        const PageArray<Mate>& mates = tree_.mates;
        for (; nextMate_ < mates.size() && mates[nextMate_].newcomer == next_; ++nextMate_) join(mates[nextMate_]);
        const ShapeRecord& shape = tree_.shapes.record(next_);
        if (shape.sharesPlace || shape.meetsNobody) continue;
        const uint32_t count = tree_.jointCount(next_);
        const uint32_t axes = axesThatMayMeet(shape);
        for (uint32_t j = 0; axes != 0 && j < faceCount; ++j)
            if (axes >> (j / 2) & 1) arrive({next_, j});
        for (uint32_t j = firstNamedJoint; j < count; ++j) arrive({next_, j});
    }
}

std::optional<JointState> BondsInPlanes::stateOf(ShapeId id, uint32_t index) {
    const Joint joint = tree_.joint(id, index);
    if (isDirected(joint)) {
        const Where where = whereIs(joint);
        if (where.kind == Where::Kind::Unclear) return std::nullopt;
        if (where.kind == Where::Kind::Away) {
            if (planes_.size() == mostPlanes) return std::nullopt;
            addPlane(joint);
        }
    }
    follow();
    if (isUnclear_) return std::nullopt;
    return stateAt({id, index});
}

}  // namespace sgm::derive
