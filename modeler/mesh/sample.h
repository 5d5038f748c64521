// The field's values at a block's corners, brick by brick, each brick with its own shortened tape.
// Enters: a block. Leaves: which bricks may hold surface; their tapes and values, one brick after the other. Assumes
// pruning is exact: the bricks around a corner would all compute the same bits for it, so one of them does.
#pragma once

#include <array>
#include <bit>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/coarse.h"
#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {

/// One worker's samples, reused from block to block.
class BlockSamples {
public:
    /// Goes to a block: asks the field's range in each brick.
    void enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts);
    /// Bricks that may hold surface, by number.
    uint64_t active() const { return active_; }
    /// Whether `sample` answers the block's own tape for every brick.
    bool oneTape() const { return oneTape_; }
    /// Shortens the tape to an active brick and evaluates the corners that no lower brick has. To be called in
    /// ascending order; the tape lasts until the next call.
    const eval::Tape& sample(int brick, eval::Workspace& workspace, Counts& counts);

    /// The block's samples by corner; those of active bricks are there once their brick was sampled. Corners on the
    /// grid's border or beyond are never inside.
    const float* values() const { return values_.data(); }
    /// Coordinate of corners i along `axis`, metres.
    const float* coordinates(int axis) const { return coordinates_[axis].data(); }

private:
    const SampleRows& rowsOf(int brick);
    uint64_t onBorder(uint64_t bricks) const;
    void sealBorder(Vec3i brick);

    static constexpr int maxBatch = brickCorners * brickCorners * brickCorners + rowPadding;

    const Block* block_ = nullptr;
    eval::Care care_;
    uint64_t active_ = 0;
    bool dear_ = false;  ///< `coarse_` takes care of the bricks
    bool oneTape_ = false;
    CoarseSamples coarse_;
    std::array<uint8_t, bricksPerBlock> region_{};  ///< of a brick, in the last evaluateRanges
    eval::Tape tape_;
    int inVain_ = 0;  ///< latest bricks of the block that needed its whole tape
    Vec3i last_;  ///< the highest corner in the grid, counted from the block's first
    PageVector<float> values_ = PageVector<float>(cornersPerBlock + rowPadding);
    CornerCoordinates coordinates_{};
    std::array<float, maxBatch> x_, y_, z_, f_;
    SampleRows cutOff_;  ///< of a brick that the grid's end cuts off
};

}  // namespace sgm::mesh
