// Edges of a simplified mesh that are straight where the field is curved.
// Enters: a crisp mesh and its field. Leaves: the mesh with such edges split. Assumes a mesh that doesn't cross itself;
// afterwards it still doesn't.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Splits edges whose middle is farther than `tolerance_m` (> 0) from the surface, or from the crease that they run
/// along, with a vertex on that: a cell spans an arch of four cells with a chord that is .03 cells off. Of a piece that
/// has more corners inside than at its borders only edges from border to border are looked at, and those of 400
/// tolerances that are off by four, as along a column in cells of two sizes: rough and organic surfaces, which no cells
/// follow, stay as they are. Splits after which triangles would fold over or cross are left out. The mesh has one chunk
/// afterwards, if anything was split. Returns how many edges were. `threads` 0: all; the result is the same for any
/// number. O(n), and ten evaluations of the shortened field an edge. Error::Cancelled leaves the mesh as it was.
Result<size_t> splitCurvedEdges(Mesh& mesh, const eval::Tape& field, double tolerance_m, int threads,
                                Progress* progress);

}  // namespace sgm::mesh
