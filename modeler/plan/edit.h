// What is done to footprints: booleans, offsets, setbacks, courts, rectifying.
// Enters: sound footprints (validate.h). Leaves: new sound footprints, empty where nothing is left. Assumes coordinates
// within 10⁵ m. Booleans and offsets are Clipper's (A. Johnson, 6.4.2; Vatti 1992) on a lattice of 2⁻²⁰ m; slivers
// below 10⁻⁵ m² and points nearer than a millimetre are left out, and where rings would touch all is .2 mm smaller.
// Edges keep their tags: what runs along a source edge, or along its offset, has that edge's tag and source.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

enum class Boolean { Union, Difference, Intersection };
/// a ∪ b, a − b or a ∩ b. Edges of `b` that cut `a` are EdgeSource::Cut in a difference. O((n + k) log n), k crossings.
Footprint boolean(Boolean how, const Footprint& a, const Footprint& b);
/// The same of outlines that anybody may have drawn: Error::Budget where they cross more than 20,000 times, or where
/// finding out takes 2·10⁸ steps.
Result<Footprint> booleanInBudget(Boolean how, const Footprint& a, const Footprint& b);
/// Whether two sound footprints share more than `least_m2`. The same number of steps at most: edges that cross so often
/// as booleanInBudget() refuses are taken for an area.
bool shareArea(const Footprint& a, const Footprint& b, double least_m2);
/// Outlines that may cross themselves, and courts, resolved by winding ≠ 0: what is left is sound. For outlines drawn
/// by a turtle. Points beyond 10⁵ m or not finite are Error::Input, more than 20,000 crossings Error::Budget.
Result<Footprint> resolved(const Footprint& footprint);

/// Outward by `distance_m`, inward where negative, with mitred corners (at most 4 times the distance long, bevelled
/// beyond). Parts that fall apart stay one footprint; courts shrink and grow the other way. O(n log n).
Footprint offset(const Footprint& footprint, double distance_m);
/// The rim of `width_m` inside the outline; what is inside of it is offset(−width).
Footprint rim(const Footprint& footprint, double width_m);
/// Every edge moved inward by its own distance ≥ 0, metres, by number as in edgesOf(). Neighbours meet where their
/// moved lines do; where those meet far off (nearly parallel) a step is left.
Footprint setback(const Footprint& footprint, std::span<const double> distances_m);
/// The same of an outline that anybody may have drawn: Error::Budget where what is too near to the edges overlaps in
/// more than 20,000 crossings, or reaches over so many edges that finding its parts takes 2·10⁷ steps.
Result<Footprint> setbackInBudget(const Footprint& footprint, std::span<const double> distances_m);
/// With a court that leaves wings of `wing_m`; its edges are EdgeSource::Court and tagged "court". Nothing where the
/// wings leave no court, or are no wider than 0.
std::optional<Footprint> court(const Footprint& footprint, double wing_m);

/// Edges within `tolerance` radians of the plan's main direction, or square to it, are laid along it through their
/// middles; corners are found again. The main direction is the one along which most metres of edges run. The footprint
/// itself where the result wouldn't be sound.
Footprint rectified(const Footprint& footprint, double tolerance);

/// The largest rectangle along x and z that lies inside. Exact for rectilinear plans; for others within about 2 % of
/// the largest area. Nothing for an empty footprint. O((n + 64)² · n).
std::optional<Box2> innerRectangle(const Footprint& footprint);

}  // namespace sgm::plan
