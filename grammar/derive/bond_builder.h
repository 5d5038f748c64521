// Bonds shapes of a tree under construction, and finds whom their faces meet.
// Enters: shapes that stand in the tree, and their joints. Leaves: bonds, and the lists of them by joint. Assumes one
// thread.
#pragma once

#include "grammar/derive/recorder.h"

namespace sgm::derive {

class BondBuilder {
public:
    BondBuilder(ShapeTree& tree, JointIndex& joints, Monitor& monitor, const Recorder& recorder)
        : tree_(tree), joints_(joints), monitor_(monitor), recorder_(recorder) {}

    /// Joins two joints; the shift is what lies between their points. A directed bond closes both, any other leaves
    /// them open. Where a centre came to our face, the newcomer's face that looks back counts as bonded too.
    void bond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    /// Bonds every face of `id` that coincides with another's, so that no rule grows there again. Call after the bond
    /// that placed it.
    void bondCoincidentFaces(ShapeId id);
    /// Frees the joints of those that are bonded to a shape that vanishes.
    void release(ShapeId id);
    /// After the last piece that runs again: whether those that stayed where they are meet whom they met, and bonds'
    /// shifts.
    bool revalidateContacts();
    size_t jointsIndexed() const { return joints_.size(); }
    /// True where the shape doesn't share the joints of its parent.
    bool ownsBody(ShapeId id) const { return tree_.bodies[tree_.shapes[id].body].owner == id; }

private:
    struct Contact {
        uint32_t joint;
        Joint at;
        JointIndex::Spot spot;
    };
    void join(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    void linkBond(uint32_t bond, int end);
    uint32_t& firstBondAt(ShapeId id, uint32_t joint);
    void replayBond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    void replayContacts(ShapeId id);

    ShapeTree& tree_;
    JointIndex& joints_;
    Monitor& monitor_;
    const Recorder& recorder_;
    std::vector<Contact> meeting_;  ///< scratch of bondCoincidentFaces
};

}  // namespace sgm::derive
