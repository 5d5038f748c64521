// Some of a grid's cells, meshed with smaller cells.
// Enters: a field and cells. Leaves: the crisp surface in them. Assumes what `subdivide` and `polygonize` do.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/vec_hash.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The grid whose cells are those of `grid`, halved so many times: every corner of `grid` is one of its corners, bit by
/// bit.
Grid halved(const Grid& grid, int halvings);

class PartsOfBlocks;

/// Meshes cells of a grid with cells halved so many times, at least once and at most log₂ brickCells times.
class FineCells {
public:
    /// On `threads` threads (0: all). `field` and `grid` have to stay.
    FineCells(const eval::Tape& field, const Grid& grid, int halvings, int threads, Progress* progress);

    /// Whether the surface in a cell is there.
    bool has(Vec3i cell) const { return meshed_.contains(cell); }
    /// Meshes cells of the grid, and those across the sides of blocks. O(n) in what is new and in the blocks so far.
    /// Errors as of subdivide and polygonize, and Error::Budget for 2³¹ vertices.
    Status add(std::span<const Vec3i> cells);
    /// The surface in them; it ends on their sides. What is new comes behind what was there.
    const Chunk& surface() const { return surface_; }

private:
    Status findBlocks(const CellSet& indices);
    Result<Chunk> meshParts(const PartsOfBlocks& parts);
    Status append(Chunk added);
    bool isOnSide(Vec3f p) const;

    const eval::Tape& field_;
    const Grid& grid_;
    const Grid fine_;
    const int halvings_, threads_;
    Progress* const progress_;
    CellSet meshed_;
    CellSet asked_;              ///< blocks that were asked for
    std::vector<Block> blocks_;  ///< those of them that may hold surface, in order of (z, y, x)
    std::unordered_map<Vec3f, uint32_t, Vec3fHash> onSides_;  ///< the surface's vertices on sides of cells
    Chunk surface_;
};

}  // namespace sgm::mesh
