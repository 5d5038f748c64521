// Solids over a footprint that aren't roofs: prisms, tapered ones, shells, mouldings.
// Enters: a footprint as a field, heights along its y. Leaves: Fields with |∇f| = 1 almost everywhere, so that they
// blend, morph and are clad like a box. Assumes bottom < top. Faces are planes with labels of their own
// (docs/design/crisp-meshes.md). `path` keys the solid's own slots (0: fresh ones); two solids must not share one, nor
// a solid and the plan. The zero set is exact; beyond corners the distance is mitred: at most the true one.
#pragma once

#include <span>

#include "modeler/core/result.h"
#include "modeler/field/plan_field.h"

namespace sgm::field {

/// max(Φ, bottom − y, y − top). Metres.
Field prism(const PlanField& plan, Quantity bottom, Quantity top, uint64_t path = 0);
/// A prism whose sides lean inward by `angle` radians (outward where negative), |angle| < 85°; the outline is that of
/// its bottom.
Field taperedPrism(const PlanField& plan, Quantity bottom, Quantity top, Quantity angle, uint64_t path = 0);
/// Walls of `wall` metres along the inside of the outline, a floor and a ceiling of their own thickness (0: open
/// there).
Field shell(const PlanField& plan, Quantity bottom, Quantity top, Quantity wall, Quantity floor, Quantity ceiling,
            uint64_t path = 0);
/// A profile swept along all outlines, mitred at corners, courts included: `profile` is a closed polygon in
/// (metres outward of the outline, metres above `foot`); it may lie on both sides of the outline and run either way.
/// Error::Input with the fault of the profile.
Result<Field> moulding(const PlanField& plan, std::span<const plan::Vec2> profile, Quantity foot, uint64_t path = 0);

}  // namespace sgm::field
