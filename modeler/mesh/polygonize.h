// Blocks to triangles: marching cubes that is closed, oriented and 2-manifold in every case.
// Enters: blocks with their tapes. Leaves: a Mesh, the same bytes at any thread count. Assumes blocks from `subdivide`
// on the same grid. Lorensen & Cline 1987 (SG-M III-G); the case table's rule stands in marching_cubes.h.
#pragma once

#include <functional>
#include <span>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tally.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

/// How the surface goes through cells.
enum class Surface {
    Cubes,  ///< marching cubes: edges are chamfered, borders of materials follow the cells
    Crisp   ///< the same, but split along creases and borders, which are solved on the faces of cells
};

struct PolygonizeOptions {
    Surface surface = Surface::Cubes;
    int halvings = 3;  ///< crisp cells around thin parts are halved so often at most; asked of who knows the parts
    /// All crisp cells may be halved where that takes less time. False: what doesn't change from mesh to mesh keeps its
    /// vertices.
    bool halvesAll = true;
    /// So many triangles, or four times those that it has, a mesh may come to have by that.
    size_t halvedTriangles = 8'000'000;
    /// Of Crisp, for a mesh that is simplified next, which takes less time then: flat cells become fans (flat_cells.h),
    /// cells along straight creases strips (straight_runs.h), and vertices amid them stay without triangles. The
    /// surface is the same, but for what is thinner than a cell beside such a crease.
    bool mergesCells = false;
    int threads = 0;      ///< 0 = all
    int refineSteps = 3;  ///< evaluations a vertex may take after linear interpolation; 0 = the paper's interpolation
    bool positionsOnly = false;  ///< of Cubes: the shape alone, which is the same: chunks without normals and origins
    uint64_t memoryBudget_bytes = 8ull << 30;  ///< Error::Budget beyond
    eval::Tally* tally = nullptr;              ///< adds up the operations that samples, vertices and origins took
    bool timeField = false;                    ///< reads the clock around every evaluation, which takes time itself
};

/// The first half of `polygonize`: the chunks of those blocks that hold surface, in the blocks' order, each by itself;
/// `link` (chunk.h) is the other half.
Result<std::vector<Chunk>> meshBlocks(std::span<const Block> blocks, const Grid& grid, const PolygonizeOptions& options,
                                      Progress* progress, Counts& counts);

Result<Mesh> polygonize(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                        Progress* progress, Counts& counts);

/// Given the chunks of a mesh one after the other. `window` holds the chunk, complete as in a whole mesh, and all that
/// lend to it.
using ChunkVisitor = std::function<Status(const Mesh& window, const Chunk& chunk)>;

/// As `polygonize`, for a mesh that needn't fit into memory: holds no more than three layers of blocks along z at a
/// time. The memory budget is a layer's. Ends with the visitor's first error.
Status polygonizeInLayers(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                          Progress* progress, Counts& counts, const ChunkVisitor& visit);

}  // namespace sgm::mesh
