// A field: one scalar node plus what is known about the whole of space around it.
// Enters: a node and its bounds, from primitives.h, combine.h, domain.h. Leaves: a value to combine further or compile.
// Assumes f < 0 inside (SG-M definition 4). Every function that makes a Field also makes its three bounds.
#pragma once

#include "modeler/core/vec.h"
#include "modeler/field/graph.h"

namespace sgm::field {

/// A scalar field over space, in metres, with three promises that tests hold it to:
struct Field {
    NodeRef value;
    /// Every point with f < 0 lies in this box. Not finite for a half-space; empty for the empty shape.
    Box3f bounds;
    /// |f(p) − f(q)| ≤ lipschitz · |p − q| everywhere; 1 for a true distance. Infinite where the field jumps (a KIFS
    /// with a bailout or a turned jump): intervals still hold, but a tracer must choose its own steps.
    float lipschitz = 1;
    /// f(p) ≥ growth · distance(p, bounds) outside the bounds: lets unions drop far groups. 0 when nothing is known.
    float growth = 1;
};

}  // namespace sgm::field
