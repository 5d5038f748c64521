// Which joints in a few planes are bonded, without making the bonds of all others.
// Enters: a tree that grows, and joints in question. Leaves: their states, as BondMaker's bonds give them. Assumes that
// shapes stand still and none is removed. Faces meet in their plane alone, and only those that look at each other:
// where one side of a plane is empty, or a new joint is closed by its mate, there is no search, and no face is indexed.
#pragma once

#include <optional>
#include <vector>

#include "grammar/derive/joints.h"

namespace sgm::derive {

/// What bonds have made of a joint.
enum class JointState : uint8_t {
    Open,
    Bonded,  ///< and may be met again
    Closed   ///< by a directed bond
};

/// The states of joints that aren't open, by shape and joint: a word each.
class JointStates {
public:
    JointState of(ShapeId id, uint32_t joint) const;
    /// From open to bonded to closed; never back.
    void raise(ShapeId id, uint32_t joint, JointState state);
    void clear() { *this = {}; }

private:
    static constexpr uint64_t empty = ~uint64_t{0};
    size_t slotOf(uint64_t key) const;

    std::vector<uint64_t> slots_ = std::vector<uint64_t>(64, empty);  ///< a power of two, at least half of them empty
    size_t used_ = 0;
};

/// The states of the joints in at most eight planes, which are those of the joints in question so far.
class BondsInPlanes {
public:
    explicit BondsInPlanes(const ShapeTree& tree) : tree_(tree) {}

    /// The state of a joint with all that stands now; nothing where the planes don't decide it, or there would be too
    /// many of them: then all bonds have to be made. O(shapes that came since), and O(shapes) for a joint in a new
    /// plane.
    std::optional<JointState> stateOf(ShapeId id, uint32_t joint);

private:
    using Entry = JointIndex::Entry;
    /// The faces of a plane that look to one side.
    struct Side {
        PageArray<Entry> faces;  ///< in the order in which they came
        size_t indexed = 0;      ///< of them
        JointIndex index;
    };
    struct Plane {
        Vec3d direction;
        double offset_m = 0;
        Side sides[2];  ///< that look along the direction, and against it
    };
    /// Where a directed joint lies: in one plane, in none, or so near to one that it may meet a joint that meets one
    /// there.
    struct Where {
        enum class Kind { Away, In, Unclear } kind = Kind::Away;
        size_t plane = 0;
        bool looksBack = false;
    };
    static constexpr size_t mostPlanes = 8;

    Where whereIs(const Joint& joint) const;
    uint32_t axesThatMayMeet(const ShapeRecord& shape) const;
    void addPlane(const Joint& joint);
    void follow();
    void join(const Mate& mate);
    void arrive(Entry entry);
    ShapeId placeOf(ShapeId id, uint32_t joint) const;
    JointState stateAt(Entry e) const { return states_.of(placeOf(e.shape, e.joint), e.joint); }
    void raise(Entry e, JointState state) { states_.raise(placeOf(e.shape, e.joint), e.joint, state); }

    const ShapeTree& tree_;
    std::vector<Plane> planes_;
    JointStates states_;
    bool isUnclear_ = false;  ///< there is a face of which the planes don't decide whether it counts
    ShapeId next_ = 0;        ///< the first shape that is not followed yet
    size_t nextMate_ = 0;     ///< the same of ShapeTree::mates
};

}  // namespace sgm::derive
