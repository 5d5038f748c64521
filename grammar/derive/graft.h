// Puts the shapes of one derivation below a shape of another, so that the objects of a model become part of its field.
// Enters: two derivations of one grammar. Leaves: the first with the shapes, bonds, steps and materials of the second.
// Assumes neither is being derived any more.
#pragma once

#include <optional>

#include "grammar/derive/derive.h"
#include "modeler/core/provenance.h"

namespace sgm::derive {

/// Appends a copy of all that `object` holds as the last child of `at`; `pose` takes the object's frame to that of
/// `into`. Keys of the copy hang on that of `at`, so that the same object may be put at several places. O(shapes of the
/// object).
void graft(Derivation& into, ShapeId at, const Derivation& object, const Pose& pose);

/// The box around every solid of an object, and the material of the first one (index into its materials; none: the
/// default).
struct Mass {
    Scope box;
    uint32_t material = none;
};
/// Nothing where the object has no solids of its own.
std::optional<Mass> massOf(const Derivation& object);
/// Puts the object's mass in its stead; nothing where it has none.
void graftMass(Derivation& into, ShapeId at, const Derivation& object, const Pose& pose);

}  // namespace sgm::derive
