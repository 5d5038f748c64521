// The samples a level set needs, and no others, in the leaves OpenVDB stores. No OpenVDB here.
// Enters: a tape and the blocks that hold its surface. Leaves: leaves of 8³ samples wherever |f| may be below the band.
// Assumes eval's promise that a shortened tape gives the same bits, so the result depends on neither batches nor
// threads.
#pragma once

#include <array>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::volume {

inline constexpr int leafVoxels = 8;  ///< along an edge; mesh::brickCells, and an OpenVDB leaf
static_assert(leafVoxels == mesh::brickCells);

struct BandLeaf {
    Vec3i corner;                   ///< grid corner of values[0], a multiple of 8
    std::array<float, 512> values;  ///< metres, clamped to ±band; that of voxel (i, j, k) at (i·8 + j)·8 + k
};

/// The leaves of the band |f| < `band_m` in all blocks with surface and their 26 neighbours, where the band ends as
/// long as it is at most a block wide. A leaf is also kept when f may change sign between it and the next one, so that
/// signs can be flooded from leaf to leaf even where f jumps. Outer vector: batches in order of (z, y, x); their split
/// is arbitrary.
Result<std::vector<std::vector<BandLeaf>>> sampleBand(const std::vector<mesh::Block>& blocks, const eval::Tape& whole,
                                                      const mesh::Grid& grid, float band_m, int threads,
                                                      Progress* progress);

}  // namespace sgm::volume
