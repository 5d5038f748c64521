// Reflex corners of footprints.
// Enters: a footprint. Leaves: which edges touch one. Assumes rings in their senses (polygon.h).
#pragma once

#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// By edge, as in edgesOf(): whether one of its corners is reflex or straight; no gable stands over such an edge. O(n).
std::vector<bool> edgesAtReflexCorners(const Footprint& footprint);

}  // namespace sgm::plan
