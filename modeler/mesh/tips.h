// Tips of cones, pyramids and spires, which end thinner than a cell.
// Enters: a crisp mesh and its field. Leaves: the mesh with whole tips. Assumes a mesh that doesn't cross itself;
// afterwards it still doesn't.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Gives tips the part that no cell holds. Where the tangent planes around a vertex meet beyond it in a point of the
/// surface, the surface around it is cut off and its border joined to that apex. Tips of which that can't be done
/// without crossings stay as they are, as do all in a build without CGAL. A mesh with completed tips has one chunk.
/// `cell_m` > 0 is the mesh's. Returns how many tips were completed. `threads` 0: all; the result is the same for any
/// number. O(n), and some evaluations of the field a tip. Error::Cancelled leaves the mesh as it was.
Result<size_t> completeTips(Mesh& mesh, const eval::Tape& field, float cell_m, int threads, Progress* progress);

}  // namespace sgm::mesh
