// CGAL's straight skeleton, the judge of roofs.
// Enters: a polygon. Leaves: its nodes with their depths. Assumes that the polygon is sound.
#pragma once

#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::plan::test {

struct SkeletonFace {
    uint32_t edge = 0;  ///< as in edgesOf()
    std::vector<Vec2> corners;
    std::vector<double> depths;  ///< of the corners, metres
};
/// The faces of the polygon's straight skeleton; empty where CGAL fails.
std::vector<SkeletonFace> skeletonOf(const Polygon& polygon);

}  // namespace sgm::plan::test
