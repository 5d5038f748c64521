// Some of a grid's cells, meshed with smaller cells.
// Enters: a field and cells. Leaves: the crisp surface in them. Assumes what `subdivide` and `polygonize` do.
#pragma once

#include <vector>

#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The grid whose cells are those of `grid`, halved so many times: every corner of `grid` is one of its corners, bit by
/// bit.
Grid halved(const Grid& grid, int halvings);

/// Meshes cells of a grid with cells halved so many times (at most log₂ blockCells), whole blocks of these at once.
class FineCells {
public:
    /// On `threads` threads (0: all). `field` has to stay.
    FineCells(const eval::Tape& field, const Grid& grid, int halvings, int threads, Progress* progress);

    /// Whether the surface in a cell is there.
    bool has(Vec3i cell) const { return held_.contains(blockOf(cell)); }
    /// Meshes cells, and others in their blocks. Errors as of subdivide and polygonize, and Error::Budget for 2³¹
    /// vertices.
    Status add(std::span<const Vec3i> cells);
    /// The surface in them; it ends on their sides. What is new comes behind what was there.
    const Chunk& surface() const { return surface_; }

private:
    Vec3i blockOf(Vec3i cell) const;
    Status mesh(CellSet blocks);

    const eval::Tape& field_;
    const Grid fine_;
    const int halvings_, threads_;
    Progress* const progress_;
    CellSet held_;               ///< blocks whose triangles are there
    CellSet made_;               ///< these and the ones that own vertices of theirs
    std::vector<Chunk> chunks_;  ///< in order of (z, y, x), numbered as they came; none without surface
    Chunk surface_;
};

}  // namespace sgm::mesh
