// The straight skeleton of a polygon (Aichholzer et al. 1995), by CGAL.
// Enters: a sound polygon. Leaves: for every edge the land that is nearest to it as the outline shrinks. Assumes a few
// hundred edges at most: the time grows with their square.
#pragma once

#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::town {

/// The faces by edge, counted as in plan::edgesOf: counter-clockwise from the edge's beginning over its end. Together
/// they tile the polygon; neighbours share the very same points. Empty where CGAL finds no skeleton.
std::vector<std::vector<plan::Vec2>> skeletonFaces(const plan::Polygon& polygon);

}  // namespace sgm::town
