// A field laid over heights: what stood on level ground follows the hills.
// Enters: a field over level ground, heights over the plan. Leaves: the field with every vertical line moved up by the
// height there. Assumes that the frame of the heights is upright.
#pragma once

#include "modeler/field/domain.h"
#include "modeler/field/height_grid.h"

namespace sgm::field {

/// f(x, y − h(x, z), z), divided by the norm of that map's derivative, σ = (s + √(s² + 4)) / 2 for slopes up to s: it
/// is no steeper than f. Where h is level, f is merely lifted (and its distances are 1/σ of true ones). `frame` says
/// where the plan of the heights lies, its slots are under `path`. O(nodes of f).
Field drape(const Field& f, const SampledGridPtr& heights, const Frame& frame, uint64_t path);

}  // namespace sgm::field
