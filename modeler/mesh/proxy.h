// A proxy: a coarse closed mesh around a solid, for light, shadows, culling and collision.
// Enters: a field and how far the proxy may stand off. Leaves: a mesh of one chunk that encloses the solid. Assumes the
// field's Lipschitz bound and growth.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "modeler/field/field.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The level t > 0 of the field, polygonised in cells of c = tolerance/(2√3) and thinned as far as it still encloses.
/// With t = √3·c·L every cell that holds a point of the solid is inside altogether; where the field is a distance the
/// proxy lies at most `tolerance_m` off. Adds nodes to `graph`. Error::Usage for a tolerance that isn't positive,
/// Error::Input for a field without Lipschitz bound or growth, the errors of subdivide and polygonize.
Result<Mesh> proxy(field::Graph& graph, const field::Field& field, double tolerance_m, int threads, Progress* progress);

/// True when f > 0 is certain at every point of every triangle, by the Lipschitz bound of `tape`.
bool encloses(const Mesh& mesh, const eval::Tape& tape);

}  // namespace sgm::mesh
