// The bonds of a tree under construction: noted where newcomers are placed, made when a rule first asks for them.
// Enters: shapes that stand in the tree, and what placed them. Leaves: bonds that hold all shapes so far, each time
// somebody asks. Assumes one thread.
#pragma once

#include <optional>

#include "grammar/derive/bond_maker.h"
#include "grammar/derive/bonds_in_planes.h"
#include "grammar/derive/recorder.h"

namespace sgm::derive {

class BondBuilder {
public:
    BondBuilder(ShapeTree& tree, JointIndex& joints, Monitor& monitor, const Recorder& recorder)
        : tree_(tree), joints_(joints), monitor_(monitor), recorder_(recorder), maker_(tree, joints) {}

    /// Notes what placed the newest shape.
    void place(const Mate& mate);
    /// While pieces run again: whether the shape meets whom it met.
    void revalidate(ShapeId id);
    /// Whether a joint is bonded at all, or closed by a directed bond. Where joints of few planes are asked for, faces
    /// in those alone are looked at.
    bool isBonded(ShapeId id, uint32_t joint);
    bool isClosed(ShapeId id, uint32_t joint);
    /// The bonds of all that stands. From the first time on they follow the tree: O(joints that came since).
    const Bonds& asked();
    /// Brings bonds that were asked for up to date, and lets others be made anew when somebody asks the tree.
    void settle();
    /// Frees the joints of those that are bonded to a shape that vanishes. Call `asked` before it dies.
    void release(ShapeId id);
    /// After dead shapes were swept out: bonds what is left of shapes that were bonded, by the new ids of old shapes
    /// and the old owners of their bodies.
    void sweep(const std::vector<uint32_t>& newId, const std::vector<uint32_t>& ownerOf);
    /// After the last piece that runs again: whether those that stayed where they are meet whom they met, and bonds'
    /// shifts.
    bool revalidateContacts();
    size_t jointsIndexed() const { return joints_.size(); }

private:
    void replay(const Mate& mate);
    std::optional<JointState> stateInPlanes(ShapeId id, uint32_t joint);

    ShapeTree& tree_;
    JointIndex& joints_;
    Monitor& monitor_;
    const Recorder& recorder_;
    BondMaker maker_;
    bool areAsked_ = false;
    std::optional<BondsInPlanes> inPlanes_;  ///< until all are asked for
};

}  // namespace sgm::derive
