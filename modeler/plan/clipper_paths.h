// Footprints as Clipper takes and gives them. For the sources of this folder alone.
// Enters: footprints within 10⁵ m. Leaves: paths of points on the lattice, and footprints without tags. Assumes nothing
// of the paths that come back: slivers go, rings that touch are parted.
#pragma once

#include <vector>

#include "modeler/plan/lattice.h"

namespace sgm::plan {

/// A closed chain on the lattice.
using LatticePath = std::vector<LatticePoint>;
using LatticePaths = std::vector<LatticePath>;

enum class PathBoolean { Union, Difference, Intersection };

/// Outer rings counter-clockwise, courts clockwise, as they are in the footprint.
LatticePaths pathsOf(const Footprint& footprint);
/// The boolean of what is wound ≠ 0 by either list, as polygons with courts; without tags, not yet cleaned.
Footprint booleanOf(PathBoolean how, const LatticePaths& subject, const LatticePaths& clip);
/// What is wound an odd number of times.
Footprint evenOddOf(const LatticePaths& paths);
/// Every ring moved outward by `distance_m` with corners mitred up to 4 times that.
Footprint offsetOf(const LatticePaths& paths, double distance_m);

/// What lies within `half_m` of a chain, mitred at its corners; an open one ends square.
Footprint bandOf(const LatticePath& path, double half_m, bool closed);

/// Without points nearer than 1 mm, without slivers, and sound: where rings touch, all is moved inward by .2 mm, or a
/// little more where that doesn't do. Tags stay.
Footprint tidied(Footprint footprint);

}  // namespace sgm::plan
