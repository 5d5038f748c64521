// The outline of a class of land, from a function of the place.
// Enters: a question and a rectangle. Leaves: where the answer is yes, as polygons with courts. Assumes that what is
// narrower than a cell may be missed. Marching squares, with each crossing found by bisection.
#pragma once

#include <functional>

#include "modeler/plan/polygon.h"

namespace sgm::town {

/// Where `holds` inside the rectangle. Cells are those of one lattice of `cell_m` through 0, so that outlines of
/// neighbouring rectangles agree; an outline of more than 20,000 points is sought again on cells twice as large. Edges
/// carry `tag`.
plan::Footprint outlineOf(const std::function<bool(plan::Vec2)>& holds, plan::Vec2 lo, plan::Vec2 hi, double cell_m,
                          const std::string& tag);

/// The same answers; those at points of the lattice of `cell_m` inside the rectangle are kept, for outlines of
/// neighbouring rectangles ask there again. For one thread at a time; a byte a point. Nothing for an empty function.
std::function<bool(plan::Vec2)> remembered(std::function<bool(plan::Vec2)> holds, plan::Vec2 lo, plan::Vec2 hi,
                                           double cell_m);

}  // namespace sgm::town
