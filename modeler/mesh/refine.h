// Cells of a mesh that are halved where they hold more than they can show.
// Enters: a crisp mesh, its field, and cells. Leaves: a mesh with the surface of smaller cells in these. Assumes a
// mesh as it comes from `polygonize`, or from this function: the surface is cut along the sides of the cells, and what
// stays takes the vertices of the finer cut, so that nothing gapes.
#pragma once

#include <optional>

#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

struct RefineOptions {
    int halvings = 1;            ///< of the cells, 1 … 3
    size_t mostTriangles = ~0u;  ///< the first cells alone, or less often, where the mesh would have more, by a guess
    int threads = 0;             ///< 0: all; the result is the same for any number
};

/// A mesh some of whose cells are halved.
struct RefinedMesh {
    Mesh mesh;  ///< of one chunk
    CellSet cells;
};

/// What came of halving cells.
struct Refinement {
    std::optional<RefinedMesh> made;  ///< nothing where no cells could be halved
    bool isBounded = false;  ///< some cells weren't halved, or not so often, for the triangles would have been too many
};

/// Meshes `cells` of `grid` anew with smaller cells. Where the two surfaces don't fit on a side of the cells, more
/// cells around are taken; where that doesn't help, or triangles would cross, a component of cells stays as it was.
/// No cells can be halved in a build without CGAL, and where smaller cells are too small or too
/// many to be meshed. What meshing the cells takes, and O(n) in the mesh for copying it. Error::Cancelled.
Result<Refinement> refineCells(const Mesh& mesh, const eval::Tape& field, const Grid& grid, const CellSet& cells,
                               const RefineOptions& options, Progress* progress);

}  // namespace sgm::mesh
