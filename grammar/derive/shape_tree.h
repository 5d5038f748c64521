// The shape tree: scopes, joints (SG-M eq. 15), bonds (eq. 16), and the nodes they join.
// Enters: what the interpreter places. Leaves: flat arrays that `lower` and `sgm tree` walk. Assumes parents come
// before their children. Nothing here recurses: a chain may be thousands of shapes deep.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/derive/bonds.h"
#include "grammar/derive/footprints.h"
#include "grammar/derive/shapes.h"
#include "grammar/rules/grammar.h"
#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"

namespace sgm::derive {

/// A joint point J = (P, D), eq. 15, in the object's frame.
struct Joint {
    std::string_view name;  ///< "+x" … "-z", "centre", or declared
    Vec3d point;
    Vec3d direction;  ///< unit; zero meets any other
};

/// An evaluated solid, numbers bound.
struct SolidValue {
    rules::Solid::Kind kind = rules::Solid::Kind::Nil;
    const field::Primitive* primitive = nullptr;
    std::vector<rules::Value> args;  ///< one per row parameter
    std::vector<SolidValue> parts;   ///< Morph: two; Combination: in order
    rules::Operator op = rules::Operator::None;
    double amount = 0;  ///< Morph: a in 0 … 1
    friend bool operator==(const SolidValue&, const SolidValue&) = default;
};

struct Displacement {
    bool fbm = false;
    double amplitude_m = 0, frequency = 1;
    int octaves = 2;
    uint64_t key = 0;  ///< of the shape whose pattern it has; 0: of its own
    Pose frame;        ///< in which the pattern lies: object from local
    friend bool operator==(const Displacement&, const Displacement&) = default;
};

/// What dresses a shape: an `ornament` and how it looks.
struct Cladding {
    SolidValue ornament;
    std::string name;          ///< of its terminal, "" for none
    uint32_t material = none;  ///< index into Derivation::materials; none: the shape's own
    friend bool operator==(const Cladding&, const Cladding&) = default;
};

/// What few shapes have.
struct Extras {
    std::vector<Cladding> clad;          ///< at most one; acts on the node's whole content, before noise
    std::vector<Displacement> displace;  ///< acts on the node's whole content
    std::vector<std::pair<std::string, rules::Value>> values;  ///< `with`
    std::vector<std::string> tags;
    std::vector<std::pair<uint32_t, double>> reports;  ///< by index in Grammar::reports
    uint32_t object = none;                            ///< index into Derivation::objects: what `place` puts here
    uint32_t relief = none;  ///< index into Derivation::reliefs: what lifts the node's whole content, after noise
    double lift_m = 0;       ///< by how much a relief lifts the object
    bool laid = false;       ///< textures of the node's whole content begin at its scope's corner
    std::optional<Scope> laidScope;  ///< in place of the shape's own scope, where what it matched was changed first
    bool empty() const {
        return !laid && clad.empty() && displace.empty() && values.empty() && tags.empty() && reports.empty() &&
               object == none && relief == none;
    }
};

/// The shape tree; shapes[0] is the root.
struct ShapeTree {
    Shapes shapes;
    std::vector<SolidValue> solids;
    std::vector<Extras> extras;
    std::vector<std::string> labels;
    std::vector<std::vector<rules::Joint>> namedJoints;  ///< sets of declared joints; set 0 is empty
    Footprints footprints;
    PageArray<Mate> mates;        ///< what placed newcomers, in their order
    BondsOnDemand bondsOnDemand;  ///< what `bonds` made

    const SolidValue* solidOf(ShapeId id) const {
        const uint32_t solid = shapes.record(id).solid;
        return solid == none ? nullptr : &solids[solid];
    }
    const Extras* extrasOf(ShapeId id) const {
        const uint32_t index = shapes.record(id).extras;
        return index == none ? nullptr : &extras[index];
    }
    /// The joints of a shape are 0 … jointCount − 1.
    uint32_t jointCount(ShapeId id) const;
    Joint joint(ShapeId id, uint32_t index) const;
    /// The joint called `name`, or none.
    uint32_t findJoint(ShapeId id, std::string_view name) const;
    /// Who is bonded to whom: made when first asked for, O(joints). From any thread.
    const Bonds& bonds() const;
    /// "Cave/Cell[3]": labels from the root, occurrences from 2 on in brackets; the middle of very deep paths is elided
    /// unless `whole`.
    std::string path(ShapeId id, bool whole = false) const;
    /// The box, in the shape's axes, around every solid of its content; what only cuts doesn't count.
    Scope contentBox(ShapeId id) const;
    /// The shape at a path; where no child matches a part, the n-th descendant of that label in tree order.
    ShapeId find(std::string_view path) const;
    /// The next shape in tree order (a node, then its children), or none; skips the children of `id` when `over`.
    ShapeId next(ShapeId id, ShapeId root = 0, bool over = false) const;
};

/// Local direction of a face joint: +x −x +y −y +z −z; zero for the centre.
Vec3d faceDirection(uint32_t joint);
/// "+x" … "-z", "centre".
std::string_view faceName(uint32_t joint);

}  // namespace sgm::derive
