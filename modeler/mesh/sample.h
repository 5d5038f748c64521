// The field's values at a block's corners, brick by brick, each brick with its own shortened tape.
// Enters: a block. Leaves: values at every corner of its active bricks, and the bricks' tapes. Assumes pruning is
// exact: the bricks around a corner would all compute the same bits for it, so one of them does.
#pragma once

#include <array>
#include <bit>
#include <vector>

#include "modeler/mesh/region.h"

namespace sgm::mesh {

inline constexpr int bricksAlong = blockCells / brickCells;
inline constexpr int bricksPerBlock = bricksAlong * bricksAlong * bricksAlong;
inline constexpr int blockCorners = blockCells + 1;
inline constexpr int brickCorners = brickCells + 1;

/// A brick's number in its block, and its coordinates there.
constexpr int brickNumber(Vec3i at) { return at.x + bricksAlong * (at.y + bricksAlong * at.z); }
constexpr Vec3i brickAt(int number) {
    return {number % bricksAlong, number / bricksAlong % bricksAlong, number / (bricksAlong * bricksAlong)};
}

/// One worker's samples, reused from block to block.
struct BlockSamples {
    uint64_t active = 0;                           ///< bricks that may hold surface, by number
    std::array<eval::Tape, bricksPerBlock> tapes;  ///< of the active bricks
    std::vector<float> values = std::vector<float>(blockCorners * blockCorners * blockCorners);  ///< x fastest

    const float* row(int j, int k) const { return values.data() + blockCorners * (j + blockCorners * k); }
    float* row(int j, int k) { return values.data() + blockCorners * (j + blockCorners * k); }
};

/// Fills `samples` for the block; false when it was cancelled on the way.
bool sampleBlock(const Block& block, const Grid& grid, eval::Workspace& workspace, const Progress* progress,
                 BlockSamples& samples, Counts& counts);

}  // namespace sgm::mesh
