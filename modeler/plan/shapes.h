// Plans by name: what `footprint ell(…)` and its like draw.
// Enters: lengths in metres, angles in radians. Leaves: footprints centred on their bounding box, but for `arc`.
// Assumes nothing: lengths that don't fit are Error::Input with the parameter's name and the range it must lie in.
#pragma once

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// width along x, depth along z.
Result<Footprint> rectangle(double width_m, double depth_m);
/// An L: the rectangle less its quarter at +x +z. `wingX` is the depth (along z) of the wing along x, `wingZ` the width
/// (along x) of the wing along z.
Result<Footprint> ell(double width_m, double depth_m, double wingX_m, double wingZ_m);
/// A T: a bar of `bar` depth along the whole −z side, a stem of `stem` width from the bar's middle to +z.
Result<Footprint> tee(double width_m, double depth_m, double bar_m, double stem_m);
/// A U that is open towards +z: wings of `wing` around three sides of a yard.
Result<Footprint> yard(double width_m, double depth_m, double wing_m);
/// The rectangle with a court that leaves `wing` on every side; the court's edges are tagged "court".
Result<Footprint> ring(double width_m, double depth_m, double wing_m);
/// A regular polygon of 3 to 10,000 sides whose corners lie on a circle, one side towards −z.
Result<Footprint> ngon(int sides, double radius_m);
/// As `ngon`, but with the area of the circle, so that it stands for a round plan.
Result<Footprint> round(int sides, double radius_m);
/// A piece of a ring about (0, 0) from one angle to the other (from +x towards +z), of `segments` chords along each
/// side; edges are tagged "outer", "inner" and "end". Not centred: the circle's centre stays at (0, 0).
Result<Footprint> arc(double inner_m, double outer_m, double from, double to, int segments);

}  // namespace sgm::plan
