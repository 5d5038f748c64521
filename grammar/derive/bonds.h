// Who is bonded to whom (SG-M eq. 16), and holding that until somebody asks.
// Enters: shapes in the order in which they came. Leaves: lists of bonds by place and joint. Assumes nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "grammar/rules/grammar.h"
#include "modeler/core/pages.h"
#include "modeler/core/vec.h"

namespace sgm::derive {

using ShapeId = uint32_t;
inline constexpr uint32_t none = rules::none;

/// Joints 0 … 5 are the faces +x −x +y −y +z −z, 6 is the centre; 7 and on are those the symbol or its solid names.
inline constexpr uint32_t faceCount = 6, centreJoint = 6, firstNamedJoint = 7;

/// B = (J₁, J₂) ⇔ J₁.P = J₂.P ∧ J₁.D = −J₂.D, eq. 16, or a D of zero, which meets any other.
/// Where the grammar says `shift`, `overlap` or `move`, J₁.P stands for the moved point J₁.P + shift.
/// A bond of two directed joints closes both: nothing more is put there. A bond with a D of zero at either end (what
/// merges cave cells and puffs) leaves the joint open: a rule that names it may meet it again, `free(…)` won't pick it.
struct Bond {
    ShapeId shape[2];
    uint32_t joint[2];     ///< indices of the shapes' joints
    Vec3d shift;           ///< S_J and what else moved the mating point, metres, in the object's frame
    bool directed = true;  ///< both joints have a direction
    uint32_t next[2];      ///< next bond of either shape's body, or none
};

/// What placed a newcomer: its joint that met one of a shape that stood.
struct Mate {
    ShapeId host = none;
    uint32_t ours = none;  ///< index of the host's joint
    ShapeId newcomer = none;
    uint32_t theirs = none;  ///< index of the newcomer's joint
    friend bool operator==(const Mate&, const Mate&) = default;
};

/// The joints of one place in space, shared by a shape and the content that fills its scope exactly: A, rewritten to a
/// B of the same scope, passes its bonds on to B.
struct Body {
    ShapeId owner = none;       ///< the first shape that stood here
    uint32_t bond[7];           ///< by joint: the first bond that met it, or none
    uint32_t firstBond = none;  ///< list of all its bonds, linked by Bond::next
    Body() {
        for (uint32_t& b : bond) b = none;
    }
};

/// The bonds of a shape tree.
struct Bonds {
    std::vector<Bond> all;
    PageVector<Body> bodies;
    PageVector<uint32_t> bodyOf;   ///< by shape: index into `bodies`
    PageVector<uint32_t> namedAt;  ///< by shape: index into `named` of its first named joint, or none
    std::vector<uint32_t> named;   ///< the first bond of each named joint, or none

    /// The first bond that met a joint, or none.
    uint32_t at(ShapeId id, uint32_t joint) const {
        return joint < firstNamedJoint ? bodies[bodyOf[id]].bond[joint] : named[namedAt[id] + joint - firstNamedJoint];
    }
    uint32_t& at(ShapeId id, uint32_t joint) {
        return joint < firstNamedJoint ? bodies[bodyOf[id]].bond[joint] : named[namedAt[id] + joint - firstNamedJoint];
    }
    /// True when a directed bond has closed the joint.
    bool closed(ShapeId id, uint32_t joint) const {
        const uint32_t bond = at(id, joint);
        return bond != none && all[bond].directed;
    }
    /// True where the shape doesn't share the joints of one above it.
    bool ownsBody(ShapeId id) const { return bodies[bodyOf[id]].owner == id; }
    /// Bytes of the lists.
    uint64_t memory() const {
        return all.capacity() * sizeof(Bond) + bodies.capacity() * sizeof(Body) +
               (bodyOf.capacity() + namedAt.capacity() + named.capacity()) * sizeof(uint32_t);
    }
};

/// Bonds that are made when they are first asked for.
class BondsOnDemand {
public:
    BondsOnDemand() = default;
    BondsOnDemand(const BondsOnDemand& other) : made_(copyOf(other)) {}
    BondsOnDemand(BondsOnDemand&& other) noexcept : made_(std::move(other.made_)) {}
    BondsOnDemand& operator=(const BondsOnDemand& other) {
        if (this != &other) made_ = copyOf(other);
        return *this;
    }
    BondsOnDemand& operator=(BondsOnDemand&& other) noexcept {
        made_ = std::move(other.made_);
        return *this;
    }
    ~BondsOnDemand() = default;

    /// The bonds; those of `make` where nobody has asked yet. From any thread.
    template <class Make>
    const Bonds& get(Make&& make) const {
        const std::lock_guard lock(mutex_);
        if (!made_) made_ = std::make_unique<Bonds>(make());
        return *made_;
    }
    /// Null where nobody has asked yet. Assumes that nobody asks at the same time.
    Bonds* made() { return made_.get(); }
    const Bonds* made() const { return made_.get(); }
    /// Empty lists, to be filled while shapes come. Assumes that nobody asks at the same time.
    Bonds& begin() { return *(made_ = std::make_unique<Bonds>()); }
    /// The next one who asks makes them anew. Assumes that nobody asks at the same time.
    void forget() { made_.reset(); }

private:
    static std::unique_ptr<Bonds> copyOf(const BondsOnDemand& other) {
        const std::lock_guard lock(other.mutex_);
        return other.made_ ? std::make_unique<Bonds>(*other.made_) : nullptr;
    }

    mutable std::mutex mutex_;
    mutable std::unique_ptr<Bonds> made_;
};

}  // namespace sgm::derive
