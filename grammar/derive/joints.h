// Where joints stand: the index that finds coinciding faces, and the mating of a newcomer (SG-M III-F, eqs. 15–16).
// Enters: joints and scopes. Leaves: partners, and the scope a mated newcomer takes. Assumes unit directions.
#pragma once

#include <compare>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

/// Joints nearer than this are at the same point. Chains of thousands of shapes stay below it in double precision.
inline constexpr double jointTolerance_m = 1e-6;

/// Whether a joint faces a direction; centres face none.
inline bool isDirected(const Joint& joint) { return joint.direction != Vec3d{}; }

/// Finds the newcomer's face that looks back at a host's face to which the newcomer's centre came, or `none`: that face
/// counts as bonded too.
uint32_t faceLookingBack(const ShapeTree& tree, const Mate& mate);

/// P₁ = P₂ and D₁ = −D₂ within tolerance, both directed: two walls face to face.
bool faceEachOther(const Joint& a, const Joint& b);

/// A spatial hash of directed joints, for finding the face that coincides with a new one: open addressing, so that a
/// joint costs one line of memory for search and insertion together.
class JointIndex {
public:
    struct Entry {
        ShapeId shape = none;
        uint32_t joint = 0;
        friend bool operator==(const Entry&, const Entry&) = default;
        friend auto operator<=>(const Entry&, const Entry&) = default;
    };
    /// Where a joint belongs.
    struct Spot {
        uint64_t cell = 0;   ///< hash of its cell and direction
        bool inside = true;  ///< its tolerance reaches into no other cell
    };
    /// Finds a directed joint's spot and fetches the memory that `add` will want. Asked of all joints of a shape before
    /// the first is added, so that they wait for memory together.
    Spot expect(const Joint& joint) const;
    /// Adds the joint and returns the newest living one that faces it, if any.
    std::optional<Entry> add(const ShapeTree& tree, Entry entry, const Joint& joint, Spot spot);
    /// Adds the joint without a search for its partner.
    void put(Entry entry, Spot spot) { enter({spot.cell, entry}); }
    /// The newest living joint that faces this one, if any.
    std::optional<Entry> newestFacing(const ShapeTree& tree, const Joint& joint) const;
    /// For a joint that moved: enters its new spot. The old one may stay, for a joint is found only where it stands.
    void move(Entry entry, Spot spot);
    /// Calls f with every entry that faces the joint, some of them twice.
    template <class F>
    void forFacing(const ShapeTree& tree, const Joint& joint, F f) const {
        for (const uint64_t cell : cellsFacing(joint)) {
            const size_t mask = slots_.size() - 1;
            for (size_t i = cell & mask; slots_[i].entry.shape != none; i = (i + 1) & mask) {
                const Entry e = slots_[i].entry;
                if (slots_[i].cell == cell && faceEachOther(joint, tree.joint(e.shape, e.joint))) f(e);
            }
            if (const auto full = fullCells_.find(cell); full != fullCells_.end())
                for (const Entry e : full->second)
                    if (faceEachOther(joint, tree.joint(e.shape, e.joint))) f(e);
        }
    }
    /// The newest that faces the joint among those entered before `entry`.
    std::optional<Entry> partner(const ShapeTree& tree, Entry entry, const Joint& joint) const;
    size_t size() const { return used_ + inFullCells_; }
    uint64_t memory() const {
        constexpr uint64_t node_bytes = 64;
        return slots_.capacity() * sizeof(Slot) + inFullCells_ * node_bytes;
    }

private:
    struct Slot {
        uint64_t cell = 0;  ///< hash of the cell and the direction
        Entry entry;        ///< of no shape: the slot is empty
    };
    static std::vector<uint64_t> cellsFacing(const Joint& joint);
    std::optional<Entry> facing(const ShapeTree& tree, const Joint& joint, Spot spot) const;
    void grow();
    void enter(Slot slot);
    bool insert(Slot slot);
    void search(const ShapeTree& tree, uint64_t cell, const Joint& joint, std::optional<Entry>& newest) const;

    std::vector<Slot> slots_ = std::vector<Slot>(64);  ///< a power of two, at least half of them empty
    size_t used_ = 0;
    /// By cell: the entries beyond the first few, so that shapes that all stand at one place don't make long runs of
    /// slots.
    std::unordered_map<uint64_t, std::set<Entry>> fullCells_;
    size_t inFullCells_ = 0;
};

/// What a newcomer asks for: its size and orientation are given, its place follows from the joints.
struct Mating {
    Joint ours;           ///< the host's joint
    rules::Joint theirs;  ///< the newcomer's, in its own shares
    Vec3d moved_m;        ///< S_J and `move`, in the object's frame
    double overlap = 0;   ///< 0 touches, 1 puts the newcomer's centre on a face it is mated with
};

/// The scope of the newcomer: `axes` and `size` as asked, turned as little as possible so that directions oppose, and
/// placed so that points meet: C = J.P + S_J − overlap·r·D − (arm of their joint).
Scope mate(const Mating& mating, const Mat3& axes, Vec3d size);

/// The face of axes `axes` whose direction is most opposed to `direction`.
uint32_t opposedFace(const Mat3& axes, Vec3d direction);

}  // namespace sgm::derive
