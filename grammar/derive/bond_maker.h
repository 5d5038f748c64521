// Makes the bonds of shapes in the order in which they came: those that placed them, and those of faces that coincide.
// Enters: a tree, whole or still growing. Leaves: its bonds. Assumes that shapes stand still, and that they are bonded
// before one of them dies.
#pragma once

#include "grammar/derive/joints.h"
#include "grammar/derive/recording.h"

namespace sgm::derive {

/// Planes in which joints are asked for: they meet faces in the same plane alone.
class AskedPlanes {
public:
    enum class Side { Away, In, Unclear };  ///< Unclear: so near that it may meet who meets one in the plane

    /// Adds the plane of a directed joint, if there is room; false where there is none.
    bool add(const Joint& joint);
    /// Where a directed joint lies.
    Side sideOf(const Joint& joint) const;
    /// Whether some face of the box may lie in a plane or be unclear. O(planes), a few nanoseconds each.
    bool mayHold(const Scope& scope) const;

private:
    struct Plane {
        Vec3d direction;
        double offset_m = 0;
    };
    static constexpr size_t most = 8;
    std::vector<Plane> planes_;
};

class BondMaker {
public:
    /// With `only`, faces in other planes aren't bonded.
    BondMaker(const ShapeTree& tree, JointIndex& joints, const AskedPlanes* only = nullptr)
        : tree_(tree), joints_(joints), only_(only) {}

    /// Bonds the shapes that came since the last call; `notes` is told of faces that met. O(their joints).
    void follow(Bonds& bonds, MadeNotes* notes);
    /// Joins two joints; the shift is what lies between their points. A directed bond closes both, any other leaves
    /// them open. Where a centre came to our face, the newcomer's face that looks back counts as bonded too.
    void join(Bonds& bonds, const Mate& mate) const;
    /// True once a face was met of which the planes alone don't tell whether it counts.
    bool isUnclear() const { return isUnclear_; }
    /// The next `follow` begins with the first shape again.
    void restart() { next_ = 0, nextMate_ = 0; }

private:
    struct Contact {
        uint32_t joint;
        Joint at;
        JointIndex::Spot spot;
    };
    void enter(Bonds& bonds, ShapeId id) const;
    bool isLeftOut(const Joint& joint);
    void bondCoincidentFaces(Bonds& bonds, ShapeId id, MadeNotes* notes);

    const ShapeTree& tree_;
    JointIndex& joints_;
    const AskedPlanes* only_;
    bool isUnclear_ = false;
    ShapeId next_ = 0;               ///< the first shape that isn't bonded yet
    size_t nextMate_ = 0;            ///< the same of ShapeTree::mates
    std::vector<Contact> contacts_;  ///< scratch of bondCoincidentFaces
};

/// The bonds of a tree from which no shape was taken. O(joints).
Bonds bondsOf(const ShapeTree& tree);

}  // namespace sgm::derive
