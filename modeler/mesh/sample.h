// The field's values at a block's corners, brick by brick, each brick with its own shortened tape.
// Enters: a block. Leaves: which bricks may hold surface; their tapes and values, one brick after the other. Assumes
// pruning is exact: the bricks around a corner would all compute the same bits for it, so one of them does.
#pragma once

#include <array>
#include <bit>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/brick_loops.h"
#include "modeler/mesh/region.h"

namespace sgm::mesh {

inline constexpr int bricksAlong = blockCells / brickCells;
inline constexpr int bricksPerBlock = bricksAlong * bricksAlong * bricksAlong;
inline constexpr int blockCorners = blockCells + 1;
inline constexpr int brickCorners = brickCells + 1;
/// Corners of a block, and their numbers, x fastest.
inline constexpr int cornersPerBlock = blockCorners * blockCorners * blockCorners;
constexpr int cornerNumber(int i, int j, int k) { return i + blockCorners * (j + blockCorners * k); }

/// A brick's number in its block, its coordinates there and its low corner's number.
constexpr int brickNumber(Vec3i at) { return at.x + bricksAlong * (at.y + bricksAlong * at.z); }
constexpr Vec3i brickAt(int number) {
    return {number % bricksAlong, number / bricksAlong % bricksAlong, number / (bricksAlong * bricksAlong)};
}
constexpr int brickCorner(Vec3i brick) {
    return cornerNumber(brick.x * brickCells, brick.y * brickCells, brick.z * brickCells);
}

/// One worker's samples, reused from block to block.
class BlockSamples {
public:
    /// Corners that a brick has to evaluate.
    struct Rows {
        std::array<CornerRow, brickCorners * brickCorners> rows;
        size_t count = 0, points = 0;
        /// Those of a brick of so many corners, but for those on low sides that `below` names, see sampledBelow.
        void list(Vec3i corners, uint8_t below);
    };

    /// Goes to a block: asks the field's range in each brick.
    void enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts);
    /// Bricks that may hold surface, by number.
    uint64_t active() const { return active_; }
    /// Shortens the tape to an active brick and evaluates the corners that no lower brick has. To be called in
    /// ascending order; the tape lasts until the next call.
    const eval::Tape& sample(int brick, eval::Workspace& workspace, Counts& counts);

    /// The block's samples by corner; those of active bricks are there once their brick was sampled. Corners on the
    /// grid's border or beyond are never inside.
    const float* values() const { return values_.data(); }
    /// Coordinate of corners i along `axis`, metres.
    const float* coordinates(int axis) const { return coordinates_[axis].data(); }

private:
    const Rows& rowsOf(int brick);
    void sealBorder(Vec3i brick);

    static constexpr int maxBatch = brickCorners * brickCorners * brickCorners + rowPadding;

    const Block* block_ = nullptr;
    eval::Care care_;
    uint64_t active_ = 0;
    std::array<uint8_t, bricksPerBlock> region_{};  ///< of a brick, in the last evaluateRanges
    eval::Tape tape_;
    int inVain_ = 0;  ///< latest bricks of the block that needed its whole tape
    Vec3i last_;  ///< the highest corner in the grid, counted from the block's first
    PageVector<float> values_ = PageVector<float>(cornersPerBlock + rowPadding);
    std::array<std::array<float, blockCorners + rowPadding>, 3> coordinates_{};
    std::array<float, maxBatch> x_, y_, z_, f_;
    Rows cutOff_;  ///< of a brick that the grid's end cuts off
};

}  // namespace sgm::mesh
