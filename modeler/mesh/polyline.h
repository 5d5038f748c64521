// Polylines of fewer points. Enters: points. Leaves: which of them stay.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// Marks in `keep` (as long as `points`; what is marked already stays) the points of a polyline that stays within
/// `bound_m` of all points, after Ramer (1972), Douglas and Peucker (1973). The ends of an open polyline stay; of a
/// closed one, which returns from its last point to its first, at least three points do. O(n log n) as a rule, O(n) for
/// a straight line.
void simplifyPolyline(std::span<const Vec3f> points, bool closed, double bound_m, std::vector<bool>& keep);

/// The squared distance of p from the segment ab, in m².
double squaredDistance(Vec3d p, Vec3d a, Vec3d b);

}  // namespace sgm::mesh
