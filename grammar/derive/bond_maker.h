// Makes the bonds of shapes in the order in which they came: those that placed them, and those of faces that coincide.
// Enters: a tree, whole or still growing. Leaves: its bonds. Assumes that shapes stand still, and that they are bonded
// before one of them dies.
#pragma once

#include "grammar/derive/joints.h"
#include "grammar/derive/recording.h"

namespace sgm::derive {

class BondMaker {
public:
    BondMaker(const ShapeTree& tree, JointIndex& joints) : tree_(tree), joints_(joints) {}

    /// Bonds the shapes that came since the last call; `notes` is told of faces that met. O(their joints).
    void follow(Bonds& bonds, MadeNotes* notes);
    /// Joins two joints; the shift is what lies between their points. A directed bond closes both, any other leaves
    /// them open. Where a centre came to our face, the newcomer's face that looks back counts as bonded too.
    void join(Bonds& bonds, const Mate& mate) const;

private:
    struct Contact {
        uint32_t joint;
        Joint at;
        JointIndex::Spot spot;
    };
    void enter(Bonds& bonds, ShapeId id) const;
    void bondCoincidentFaces(Bonds& bonds, ShapeId id, MadeNotes* notes);

    const ShapeTree& tree_;
    JointIndex& joints_;
    ShapeId next_ = 0;               ///< the first shape that isn't bonded yet
    size_t nextMate_ = 0;            ///< the same of ShapeTree::mates
    std::vector<Contact> contacts_;  ///< scratch of bondCoincidentFaces
};

/// The bonds of a tree from which no shape was taken. O(joints).
Bonds bondsOf(const ShapeTree& tree);

}  // namespace sgm::derive
