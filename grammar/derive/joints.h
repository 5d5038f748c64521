// Where joints stand: the index that finds coinciding faces, and the mating of a newcomer (SG-M III-F, eqs. 15–16).
// Enters: joints and scopes. Leaves: partners, and the scope a mated newcomer takes. Assumes unit directions.
#pragma once

#include <optional>
#include <vector>

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

/// Joints nearer than this are at the same point. Chains of thousands of shapes stay below it in double precision.
inline constexpr double jointTolerance_m = 1e-6;

/// P₁ = P₂ and D₁ = −D₂ within tolerance, both directed: two walls face to face.
bool faceEachOther(const Joint& a, const Joint& b);

/// A spatial hash of directed joints, for finding the face that coincides with a new one.
class JointIndex {
public:
    struct Entry {
        ShapeId shape = none;
        uint32_t joint = 0;
    };
    /// Adds the joint and returns the first living one that faces it, if any.
    std::optional<Entry> add(const ShapeTree& tree, Entry entry, const Joint& joint);
    uint64_t memory() const { return slots_.capacity() * sizeof(Slot) + heads_.capacity() * sizeof(uint32_t); }

private:
    struct Slot {
        uint64_t cell;  ///< hash of the cell and the direction
        Entry entry;
        uint32_t next;  ///< next slot of this bucket, or none
    };
    void insert(uint64_t cell, Entry entry);
    std::optional<Entry> search(const ShapeTree& tree, uint64_t cell, const Joint& joint) const;

    std::vector<Slot> slots_;
    std::vector<uint32_t> heads_;  ///< buckets, a power of two, no fewer than slots
};

/// What a newcomer asks for: its size and orientation are given, its place follows from the joints.
struct Mating {
    Joint ours;             ///< the host's joint
    rules::Joint theirs;    ///< the newcomer's, in its own shares
    Vec3d moved_m;          ///< S_J and `move`, in the object's frame
    double overlap = 0;     ///< 0 touches, 1 puts the newcomer's centre on a face it is mated with
};

/// The scope of the newcomer: `axes` and `size` as asked, turned as little as possible so that directions oppose, and
/// placed so that points meet: C = J.P + S_J − overlap·r·D − (arm of their joint).
Scope mate(const Mating& mating, const Mat3& axes, Vec3d size);

/// The face of axes `axes` whose direction is most opposed to `direction`.
uint32_t opposedFace(const Mat3& axes, Vec3d direction);

}  // namespace sgm::derive
