// The field's values at a block's corners, brick by brick, each brick with its own shortened tape.
// Enters: a block. Leaves: which bricks may hold surface; their tapes and values, one brick after the other. Assumes
// pruning is exact: the bricks around a corner all compute the same bits for it where they matter, so any of them may.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/coarse.h"
#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {

/// Samples of a brick's corners: from the lowest one on, rows and layers so many floats apart.
struct BrickValues {
    const float* corner;
    uint32_t row, layer;
};

/// The coordinates of all corners of a brick, point by point, for each place it can have in its block along an axis.
class WholeBricks {
public:
    static constexpr size_t points = size_t{brickCorners} * brickCorners * brickCorners;
    /// Floats that a brick's points, or values, take: whole vectors.
    static constexpr size_t room = (points + eval::pointPadding - 1) / eval::pointPadding * eval::pointPadding;
    /// Goes to a block with corners at these coordinates.
    void enter(const CornerCoordinates& coordinates);
    eval::Points of(Vec3i brick) const {
        return {rows_[0][brick.x].at.data(), rows_[1][brick.y].at.data(), rows_[2][brick.z].at.data(), points, true};
    }

private:
    struct alignas(64) Row {
        std::array<float, room> at;
    };
    std::array<std::array<Row, bricksAlong>, 3> rows_;
    bool filled_ = false;
};

/// One worker's samples, reused from block to block.
class BlockSamples {
public:
    /// Goes to a block: asks the field's range in each brick.
    void enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts);
    /// Bricks that may hold surface, by number.
    uint64_t active() const { return active_; }
    /// Whether the block's tape is expensive.
    bool isExpensive() const { return useCoarseSampling_; }
    /// Shortens the tape to an active brick and evaluates its corners, or those that no lower brick has where the tape
    /// is long. To be called in ascending order; the tape lasts until the next call.
    const eval::Tape& sample(int brick, eval::Workspace& workspace, Counts& counts);

    /// The tape that `sample` returned for a brick of this block, where `keepTapes` was called; good in `boxOf` it.
    const eval::Tape& tapeOf(int brick) const {
        return tapes_.whole >> brick & 1 ? block_->tape : tapes_.list[static_cast<size_t>(brick)];
    }
    const Box3f& boxOf(int brick) const { return regions_.boxes[regions_.of[static_cast<size_t>(brick)]]; }
    /// From now on each brick's tape lasts until the block is left.
    void keepTapes() { tapes_.list.resize(bricksPerBlock); }

    /// The samples of an active brick, once it was sampled. Corners on the grid's border or beyond are never inside.
    BrickValues values(int brick) const {
        if (expensive_)
            return {values_.data() + brickCorner(brickAt(brick)), blockCorners, blockCorners * blockCorners};
        return {values_.data() + size_t{brickRoom} * static_cast<size_t>(brick), brickCorners,
                brickCorners * brickCorners};
    }
    /// Coordinate of corners i along `axis`, metres.
    const float* coordinates(int axis) const { return coordinates_[axis].data(); }

private:
    Vec3f cornerAt(Vec3i at) const { return {coordinates_[0][at.x], coordinates_[1][at.y], coordinates_[2][at.z]}; }
    const SampleRows& rowsOf(int brick);
    uint64_t onBorder(uint64_t bricks) const;
    void sealBorder(int brick);
    void copyFromBelow(int brick);

    static constexpr int brickRoom = WholeBricks::room;
    static constexpr int maxBatch = brickCorners * brickCorners * brickCorners + rowPadding;

    const Block* block_ = nullptr;
    /// How the block's tape becomes those of its bricks.
    struct Shortening {
        eval::RelevantRange relevant;
        std::optional<eval::RangeTrace> trace;  ///< over the bricks
    };
    Shortening shortening_;
    uint64_t active_ = 0;
    bool useCoarseSampling_ = false;  ///< the block's tape is expensive
    bool expensive_ =
        false;  ///< `coarse_` takes care of the bricks, and values_ is by the block's corners, not by brick
    bool oneTape_ = false;
    CoarseSamples coarse_;
    /// What the last evaluateRanges was asked.
    struct Regions {
        std::array<uint8_t, bricksPerBlock> of{};  ///< of a brick
        std::array<Box3f, bricksPerBlock> boxes;   ///< by region
        std::array<eval::FloatInterval, bricksPerBlock> ranges;
    };
    Regions regions_;
    /// The tapes of bricks.
    struct Tapes {
        std::vector<eval::Tape> list = std::vector<eval::Tape>(1);  ///< the latest one, or by brick
        uint64_t whole = 0;                                         ///< bricks whose tape is the block's
        int inVain = 0;  ///< latest bricks of the block that needed its whole tape
    };
    Tapes tapes_;
    Vec3i last_;  ///< the highest corner in the grid, counted from the block's first
    PageVector<float> values_ = PageVector<float>(std::max(cornersPerBlock, bricksPerBlock* brickRoom) + rowPadding);
    CornerCoordinates coordinates_{};
    WholeBricks wholeBricks_;
    PointRows<maxBatch> points_;
    alignas(64) std::array<float, maxBatch> f_;
    SampleRows cutOff_;  ///< of a brick that the grid's end cuts off
};

}  // namespace sgm::mesh
