// A field cut open by a plane, so that the cut shows what lies inside.
// Enters: a finished field of a graph. Leaves: the part of it on one side. Assumes a finite field.
#pragma once

#include "modeler/field/field.h"

namespace sgm::field {

/// Keeps where normal · p ≤ offset_m: max(f, normal · p − offset). The cut surface belongs to the part that the plane
/// runs through: of several that share a place to the one that it lies deepest in; where parts were cut or intersected,
/// to the host and not to what cut it. `normal` is unit. Adds up to twice the nodes that choose between parts.
Field section(Graph& graph, const Field& field, Vec3d normal, double offset_m);

}  // namespace sgm::field
