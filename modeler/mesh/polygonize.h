// Blocks to triangles: marching cubes that is closed, oriented and 2-manifold in every case.
// Enters: blocks with their tapes. Leaves: a Mesh, the same bytes at any thread count. Assumes blocks from `subdivide`
// on the same grid. Lorensen & Cline 1987 (SG-M III-G); the case table's rule stands in marching_cubes.h.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tally.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

struct PolygonizeOptions {
    int threads = 0;      ///< 0 = all
    int refineSteps = 3;  ///< evaluations a vertex may take after linear interpolation; 0 = the paper's interpolation
    uint64_t memoryBudget_bytes = 8ull << 30;  ///< Error::Budget beyond
    eval::Tally* tally = nullptr;              ///< adds up the operations that samples and vertices took
};

/// The first half of `polygonize`: the chunks of those blocks that hold surface, in the blocks' order, each by itself;
/// `link` (chunk.h) is the other half.
Result<std::vector<Chunk>> meshBlocks(const std::vector<Block>& blocks, const Grid& grid,
                                      const PolygonizeOptions& options, Progress* progress, Counts& counts);

Result<Mesh> polygonize(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                        Progress* progress, Counts& counts);

}  // namespace sgm::mesh
