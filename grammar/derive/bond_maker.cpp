#include "grammar/derive/bond_maker.h"

#include <cmath>
#include <utility>

namespace sgm::derive {
namespace {

bool isDirected(const Joint& j) { return j.direction != Vec3d{}; }

void linkBond(Bonds& bonds, uint32_t index, int end) {
    Bond& b = bonds.all[index];
    Body& body = bonds.bodies[bonds.bodyOf[b.shape[end]]];
    b.next[end] = std::exchange(body.firstBond, index);
    uint32_t& first = bonds.at(b.shape[end], b.joint[end]);
    if (first == none || (b.directed && !bonds.all[first].directed)) first = index;
}

constexpr double sure_m = 2 * jointTolerance_m, unsure_m = 100 * jointTolerance_m;
constexpr double sureCosine = 1 - 1e-9, unsureCosine = 1 - 1e-4;

}  // namespace

bool AskedPlanes::add(const Joint& joint) {
    if (planes_.size() == most) return false;
    planes_.push_back({joint.direction, dot(joint.point, joint.direction)});
    return true;
}

AskedPlanes::Side AskedPlanes::sideOf(const Joint& joint) const {
    Side side = Side::Away;
    for (const Plane& plane : planes_) {
        const double cosine = std::abs(dot(joint.direction, plane.direction));
        const double away_m = std::abs(dot(joint.point, plane.direction) - plane.offset_m);
        if (cosine <= unsureCosine || away_m > unsure_m) continue;
        if (cosine > sureCosine && away_m <= sure_m) return Side::In;
        side = Side::Unclear;
    }
    return side;
}

bool AskedPlanes::mayHold(const Scope& scope) const {
    constexpr double slack_m = 2 * unsure_m;
    const Vec3d half = scope.half();
    for (const Plane& plane : planes_) {
        const double away_m = std::abs(dot(scope.centre, plane.direction) - plane.offset_m);
        // Faces whose direction is unclear are turned by so little that their middles lie as far away, to a share.
        for (const double h : {half.x, half.y, half.z})
            if (std::abs(away_m - h) <= slack_m + (1 - unsureCosine) * h) return true;
    }
    return false;
}

bool BondMaker::isLeftOut(const Joint& joint) {
    if (!only_) return false;
    const AskedPlanes::Side side = only_->sideOf(joint);
    isUnclear_ = isUnclear_ || side == AskedPlanes::Side::Unclear;
    return side != AskedPlanes::Side::In;
}

void BondMaker::join(Bonds& bonds, const Mate& m) const {
    const Joint ours = tree_.joint(m.host, m.ours), theirs = tree_.joint(m.newcomer, m.theirs);
    const auto index = static_cast<uint32_t>(bonds.all.size());
    bonds.all.push_back({{m.host, m.newcomer},
                         {m.ours, m.theirs},
                         theirs.point - ours.point,
                         isDirected(ours) && isDirected(theirs),
                         {none, none}});
    linkBond(bonds, index, 0);
    linkBond(bonds, index, 1);
    if (!isDirected(ours) || isDirected(theirs)) return;
    const uint32_t back = opposedFace(tree_.shapes[m.newcomer].scope.axes, ours.direction);
    if (dot(tree_.joint(m.newcomer, back).direction, ours.direction) < -0.999 && bonds.at(m.newcomer, back) == none)
        bonds.at(m.newcomer, back) = index;
}

/// Makes room for the bonds of a newcomer.
void BondMaker::enter(Bonds& bonds, ShapeId id) const {
    const Shape& s = tree_.shapes[id];
    if (s.sharesPlace) {
        bonds.bodyOf.push_back(bonds.bodyOf[s.parent]);
    } else {
        bonds.bodyOf.push_back(static_cast<uint32_t>(bonds.bodies.size()));
        bonds.bodies.push_back(Body{});
        bonds.bodies.back().owner = id;
    }
    bonds.namedAt.push_back(s.jointSet ? static_cast<uint32_t>(bonds.named.size()) : none);
    if (s.jointSet) bonds.named.insert(bonds.named.end(), tree_.namedJoints[s.jointSet].size(), none);
}

void BondMaker::bondCoincidentFaces(Bonds& bonds, ShapeId id, MadeNotes* notes) {
    contacts_.clear();
    for (uint32_t j = 0; j < tree_.jointCount(id); ++j)
        if (const Joint joint = tree_.joint(id, j); isDirected(joint) && !isLeftOut(joint))
            contacts_.push_back({j, joint, joints_.expect(joint)});
    for (const auto& [j, joint, spot] : contacts_) {
        const auto partner = joints_.add(tree_, {id, j}, joint, spot);
        if (!partner) continue;
        if (notes) notes->met({id, j}, *partner);
        if (bonds.closed(id, j) || bonds.closed(partner->shape, partner->joint)) continue;
        if (bonds.bodyOf[partner->shape] == bonds.bodyOf[id]) continue;
        join(bonds, {partner->shape, partner->joint, id, j});
    }
}

void BondMaker::follow(Bonds& bonds, MadeNotes* notes) {
    for (; next_ < tree_.shapes.size(); ++next_) {
        enter(bonds, next_);
        const PageVector<Mate>& mates = tree_.mates;
        for (; nextMate_ < mates.size() && mates[nextMate_].newcomer == next_; ++nextMate_)
            join(bonds, mates[nextMate_]);
        const Shape& s = tree_.shapes[next_];
        if (s.sharesPlace || s.meetsNobody) continue;
        if (!only_ || s.jointSet != 0 || only_->mayHold(s.scope)) bondCoincidentFaces(bonds, next_, notes);
    }
}

Bonds bondsOf(const ShapeTree& tree) {
    Bonds bonds;
    JointIndex joints;
    BondMaker(tree, joints).follow(bonds, nullptr);
    return bonds;
}

}  // namespace sgm::derive
