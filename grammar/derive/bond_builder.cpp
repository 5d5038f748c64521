#include "grammar/derive/bond_builder.h"

#include <tuple>
#include <utility>

namespace sgm::derive {
namespace {

bool isDirected(const Joint& j) { return j.direction != Vec3d{}; }

}  // namespace

uint32_t& BondBuilder::firstBondAt(ShapeId id, uint32_t joint) {
    const Shape& s = tree_.shapes[id];
    return joint < firstNamedJoint ? tree_.bodies[s.body].bond[joint]
                                   : tree_.namedBonds[s.firstNamedBond + joint - firstNamedJoint];
}

void BondBuilder::linkBond(uint32_t index, int end) {
    Bond& b = tree_.bonds[index];
    Body& body = tree_.bodies[tree_.shapes[b.shape[end]].body];
    b.next[end] = std::exchange(body.firstBond, index);
    uint32_t& first = firstBondAt(b.shape[end], b.joint[end]);
    if (first == none || (b.directed && !tree_.bonds[first].directed)) first = index;
}

void BondBuilder::bond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB) {
    if (recorder_.isReplaying())
        replayBond(a, jointA, b, jointB);
    else
        join(a, jointA, b, jointB);
}

void BondBuilder::join(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB) {
    const Joint ja = tree_.joint(a, jointA), jb = tree_.joint(b, jointB);
    const auto index = static_cast<uint32_t>(tree_.bonds.size());
    tree_.bonds.push_back(
        {{a, b}, {jointA, jointB}, jb.point - ja.point, isDirected(ja) && isDirected(jb), {none, none}});
    linkBond(index, 0);
    linkBond(index, 1);
    if (isDirected(ja) && !isDirected(jb)) {
        const uint32_t back = opposedFace(tree_.shapes[b].scope.axes, ja.direction);
        if (dot(tree_.joint(b, back).direction, ja.direction) < -0.999 && firstBondAt(b, back) == none)
            firstBondAt(b, back) = index;
    }
}

void BondBuilder::bondCoincidentFaces(ShapeId id) {
    if (!ownsBody(id)) return;
    if (recorder_.isReplaying()) return replayContacts(id);
    meeting_.clear();
    for (uint32_t j = 0; j < tree_.jointCount(id); ++j)
        if (const Joint joint = tree_.joint(id, j); isDirected(joint))
            meeting_.push_back({j, joint, joints_.expect(joint)});
    for (const auto& [j, joint, spot] : meeting_) {
        const auto partner = joints_.add(tree_, {id, j}, joint, spot);
        if (partner && recorder_.recording()) recorder_.recording()->made().met({id, j}, *partner);
        if (!partner || tree_.closed(id, j) || tree_.closed(partner->shape, partner->joint)) continue;
        if (tree_.shapes[partner->shape].body == tree_.shapes[id].body) continue;
        if (recorder_.recording()) recorder_.recording()->made().bondedByContact(tree_.bonds.size());
        join(partner->shape, partner->joint, id, j);
    }
}

/// The bonds of a vanished place free its partners' joints.
void BondBuilder::release(ShapeId id) {
    ShapeTree& t = tree_;
    const Body& body = t.bodies[t.shapes[id].body];
    if (body.owner != id) return;
    for (uint32_t i = body.firstBond; i != none;) {
        const Bond& b = t.bonds[i];
        const int mine = t.bodies[t.shapes[b.shape[0]].body].owner == id ? 0 : 1;
        uint32_t& first = firstBondAt(b.shape[1 - mine], b.joint[1 - mine]);
        if (first == i) first = none;
        i = b.next[mine];
    }
}

void BondBuilder::replayBond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB) {
    const uint32_t index = recorder_.recording()->nextBond();
    if (index == none) return monitor_.diverge();
    const Bond& known = tree_.bonds[index];
    const std::tuple told(known.shape[0], known.joint[0], known.shape[1], known.joint[1]);
    // A centre that came to a face closes the newcomer's face that looks back: which one, hangs on how both are turned.
    const bool turned = !known.directed && (recorder_.recording()->changes().has(a, ShapeChanges::Turned) ||
                                            recorder_.recording()->changes().has(b, ShapeChanges::Turned));
    if (told != std::tuple(a, jointA, b, jointB) || turned) monitor_.diverge();
}

void BondBuilder::replayContacts(ShapeId id) {
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
    ShapeTree& t = tree_;
    const auto moved = [&](ShapeId id) { return recorder_.recording()->changes().has(id, ShapeChanges::Moved); };
    const auto asBefore = [&](JointIndex::Entry e) {
        return moved(e.shape) ||
               joints_.partner(t, e, t.joint(e.shape, e.joint)) == recorder_.recording()->made().partnerOf(e);
    };
    for (const MadeNotes::Contact& m : recorder_.recording()->made().contacts())
        if (moved(m.partner.shape) && !asBefore(m.at)) return false;
    for (const ShapeId id : recorder_.recording()->changes().shapes()) {
        if (!moved(id) || !ownsBody(id)) continue;
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
    for (Bond& b : t.bonds)
        if (moved(b.shape[0]) || moved(b.shape[1]))
            b.shift = t.joint(b.shape[1], b.joint[1]).point - t.joint(b.shape[0], b.joint[0]).point;
    return true;
}

}  // namespace sgm::derive
