#include "grammar/derive/bond_builder.h"

#include <algorithm>
#include <utility>

namespace sgm::derive {

void BondBuilder::place(const Mate& mate) {
    if (recorder_.isReplaying())
        replay(mate);
    else
        tree_.mates.push_back(mate);
}

const Bonds& BondBuilder::asked() {
    if (recorder_.isReplaying() && !areAsked_) {  // the first run asked nothing
        monitor_.diverge();
        return tree_.bonds();
    }
    inPlanes_.reset();
    Bonds& bonds = areAsked_ ? *tree_.bondsOnDemand.made() : tree_.bondsOnDemand.begin();
    areAsked_ = true;
    Recording* const recording = recorder_.recording();
    if (!recorder_.isReplaying()) maker_.follow(bonds, recording ? &recording->made() : nullptr);
    return bonds;
}

/// What bonds in a few planes tell about a joint. A second run has to know all whom faces met.
std::optional<JointState> BondBuilder::stateInPlanes(ShapeId id, uint32_t joint) {
    if (areAsked_ || recorder_.recording()) return std::nullopt;
    if (!inPlanes_) inPlanes_.emplace(tree_);
    return inPlanes_->stateOf(id, joint);
}

bool BondBuilder::isBonded(ShapeId id, uint32_t joint) {
    if (const auto state = stateInPlanes(id, joint)) return *state != JointState::Open;
    return asked().at(id, joint) != none;
}

bool BondBuilder::isClosed(ShapeId id, uint32_t joint) {
    if (const auto state = stateInPlanes(id, joint)) return *state == JointState::Closed;
    return asked().closed(id, joint);
}

void BondBuilder::settle() {
    if (areAsked_)
        asked();
    else
        tree_.bondsOnDemand.forget();
}

/// The bonds of a vanished place free its partners' joints.
void BondBuilder::release(ShapeId id) {
    Bonds& bonds = *tree_.bondsOnDemand.made();
    if (!bonds.ownsBody(id)) return;
    for (uint32_t i = bonds.bodies[bonds.bodyOf[id]].firstBond; i != none;) {
        const Bond& b = bonds.all[i];
        const int mine = bonds.bodies[bonds.bodyOf[b.shape[0]]].owner == id ? 0 : 1;
        uint32_t& first = bonds.at(b.shape[1 - mine], b.joint[1 - mine]);
        if (first == i) first = none;
        i = b.next[mine];
    }
}

void BondBuilder::sweep(const std::vector<uint32_t>& newId, const std::vector<uint32_t>& ownerOf) {
    Bonds& bonds = *tree_.bondsOnDemand.made();
    const std::vector<Bond> old = std::exchange(bonds.all, {});
    for (Body& body : bonds.bodies) body = Body{};
    for (ShapeId s = 0; s < newId.size(); ++s) {
        if (newId[s] == none) continue;
        bonds.bodyOf[newId[s]] = bonds.bodyOf[s];
        bonds.namedAt[newId[s]] = bonds.namedAt[s];
    }
    bonds.bodyOf.resize(tree_.shapes.size());
    bonds.namedAt.resize(tree_.shapes.size());
    for (ShapeId s = 0; s < tree_.shapes.size(); ++s) {
        ShapeId& owner = bonds.bodies[bonds.bodyOf[s]].owner;
        owner = std::min(owner, s);
    }
    std::fill(bonds.named.begin(), bonds.named.end(), none);
    for (const Bond& b : old) {
        // A bond made by content that was replaced stays with the shape whose place that content filled.
        ShapeId end[2];
        for (int k = 0; k < 2; ++k) {
            end[k] = newId[b.shape[k]];
            if (end[k] == none && b.joint[k] < firstNamedJoint) end[k] = newId[ownerOf[b.shape[k]]];
        }
        if (end[0] != none && end[1] != none) maker_.join(bonds, {end[0], b.joint[0], end[1], b.joint[1]});
    }
}

void BondBuilder::replay(const Mate& mate) {
    const uint32_t index = recorder_.recording()->nextMate();
    if (index == none || tree_.mates[index] != mate) return monitor_.diverge();
    if (!areAsked_) return;
    // A centre that came to a face closes the newcomer's face that looks back: which one, hangs on how both are turned.
    const ShapeChanges& changes = recorder_.recording()->changes();
    const bool directed = tree_.joint(mate.host, mate.ours).direction != Vec3d{} &&
                          tree_.joint(mate.newcomer, mate.theirs).direction != Vec3d{};
    if (!directed && (changes.has(mate.host, ShapeChanges::Turned) || changes.has(mate.newcomer, ShapeChanges::Turned)))
        monitor_.diverge();
}

void BondBuilder::revalidate(ShapeId id) {
    if (!recorder_.isReplaying() || !areAsked_) return;
    if (tree_.shapes[id].sharesPlace || tree_.shapes[id].meetsNobody) return;
    if (!recorder_.recording()->changes().has(id, ShapeChanges::Moved)) return;
    for (uint32_t j = 0; j < tree_.jointCount(id); ++j) {
        const Joint joint = tree_.joint(id, j);
        if (joint.direction == Vec3d{}) continue;
        joints_.move({id, j}, joints_.expect(joint));
        if (joints_.partner(tree_, {id, j}, joint) != recorder_.recording()->made().partnerOf({id, j}))
            return monitor_.diverge();
    }
}

bool BondBuilder::revalidateContacts() {
    if (!areAsked_) return true;
    const ShapeTree& t = tree_;
    const auto moved = [&](ShapeId id) { return recorder_.recording()->changes().has(id, ShapeChanges::Moved); };
    const auto asBefore = [&](JointIndex::Entry e) {
        return moved(e.shape) ||
               joints_.partner(t, e, t.joint(e.shape, e.joint)) == recorder_.recording()->made().partnerOf(e);
    };
    for (const MadeNotes::Contact& m : recorder_.recording()->made().contacts())
        if (moved(m.partner.shape) && !asBefore(m.at)) return false;
    for (const ShapeId id : recorder_.recording()->changes().shapes()) {
        if (!moved(id) || t.shapes[id].sharesPlace) continue;
        for (uint32_t j = 0; j < t.jointCount(id); ++j) {
            const Joint joint = t.joint(id, j);
            bool same = true;
            if (joint.direction != Vec3d{})
                joints_.forFacing(t, joint, [&](JointIndex::Entry e) {
                    same = same && (e < JointIndex::Entry{id, j} || asBefore(e));
                });
            if (!same) return false;
        }
    }
    for (Bond& b : tree_.bondsOnDemand.made()->all)
        if (moved(b.shape[0]) || moved(b.shape[1]))
            b.shift = t.joint(b.shape[1], b.joint[1]).point - t.joint(b.shape[0], b.joint[0]).point;
    return true;
}

}  // namespace sgm::derive
