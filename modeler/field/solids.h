// What the fields of the primitive table share.
// Enters: PrimitiveInput (primitives.h). Leaves: a Field filling the scope [−half, half]; the input's arguments are
// read in the row's order. Assumes half-sizes > 0. SG-M III-E with the errata in docs/papers.md; a formula on
// coordinates scaled by the half-sizes is multiplied by the least scale, so that it stays 1-Lipschitz (f(p/s)·min s).
#pragma once

#include "modeler/field/kifs.h"
#include "modeler/field/primitives.h"

namespace sgm::field::solids {

/// Of a row that begins with the parameters of `kifs` up to `terminal`: the continuous form.
ops::Kifs::Form kifsForm(std::span<const Argument> arguments);

/// The scope's box as a solid: the row `cube`, and `block` where there is no footprint.
Field cube(const PrimitiveInput& in);
/// The scope's box about the origin; a solid whose field is a maximum with the cube's or the ellipsoid's has f ≥ 0
/// outside it in every bit, because −, ÷ and √ round monotonically.
Box3f scopeBox(const PrimitiveInput& in);
/// `g` as a growth: rounded down by more than the float formulas' own rounding.
float growth(double g);
/// A position as another one less numbers: so that ops of whole solids subtract them on the way.
struct Placed {
    Point p, centre;
};
Placed placed(const Point& p);
/// The exact distance to the scope's box.
NodeRef boxDistance(const Point& p, const Point& half);
/// The same where the scope's centre isn't the origin, without nodes for the differences.
NodeRef boxDistance(const Point& p, const Point& centre, const Point& half);

}  // namespace sgm::field::solids
