#include "grammar/derive/bond_maker.h"

#include <utility>

namespace sgm::derive {
namespace {

void linkBond(Bonds& bonds, uint32_t index, int end) {
    Bond& b = bonds.all[index];
    Body& body = bonds.bodies[bonds.bodyOf[b.shape[end]]];
    b.next[end] = std::exchange(body.firstBond, index);
    uint32_t& first = bonds.at(b.shape[end], b.joint[end]);
    if (first == none || (b.directed && !bonds.all[first].directed)) first = index;
}

}  // namespace

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
    const uint32_t back = faceLookingBack(tree_, m);
    if (back != none && bonds.at(m.newcomer, back) == none) bonds.at(m.newcomer, back) = index;
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
        if (const Joint joint = tree_.joint(id, j); isDirected(joint))
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
        const PageArray<Mate>& mates = tree_.mates;
        for (; nextMate_ < mates.size() && mates[nextMate_].newcomer == next_; ++nextMate_)
            join(bonds, mates[nextMate_]);
        const ShapeRecord& s = tree_.shapes.record(next_);
        if (!s.sharesPlace && !s.meetsNobody) bondCoincidentFaces(bonds, next_, notes);
    }
}

Bonds bondsOf(const ShapeTree& tree) {
    Bonds bonds;
    JointIndex joints;
    BondMaker(tree, joints).follow(bonds, nullptr);
    return bonds;
}

}  // namespace sgm::derive
