// How often the edges of an outline cross, counted no further than somebody cares.
// Enters: an outline that may be anything. Leaves: a number. Assumes finite coordinates within 100 km.
#pragma once

#include <cstddef>

#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// The pairs of edges that cross within both, `most` + 1 where there are more, or where finding out would compare
/// more than 10,000 · `most` pairs. A sweep along x over pairs whose x-ranges meet.
size_t countCrossings(const Footprint& footprint, size_t most);
/// The same of closed chains.
size_t countCrossings(const LatticePaths& paths, size_t most);
/// More crossings than anybody draws; Clipper takes some 40 µs each.
inline constexpr size_t mostCrossings = 20'000;

}  // namespace sgm::plan
