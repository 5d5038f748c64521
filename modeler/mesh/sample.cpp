#include "modeler/mesh/sample.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// Below this a shorter tape saves less than making it costs.
constexpr size_t shortEnough = 8;

/// Which of a brick's low faces, edges and corner a lower active brick has sampled: bit d (x = 1, y = 2, z = 4) is set
/// when a corner on the low sides d lies on the high sides of some active brick.
uint8_t sampledBelow(uint64_t active, Vec3i brick) {
    uint8_t result = 0;
    for (int offset = 1; offset < 8; ++offset) {
        const Vec3i other = brick - Vec3i{offset & 1, offset >> 1 & 1, offset >> 2};
        if (minComponent(other) < 0) continue;
        if (!(active >> brickNumber(other) & 1)) continue;
        for (int d = offset; d < 8; ++d)
            if ((d & offset) == offset) result |= static_cast<uint8_t>(1 << d);
    }
    return result;
}

}  // namespace

void BlockSamples::enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts) {
    block_ = &block;
    care_ = careOf(block.tape, grid);
    const Vec3i first = block.index * blockCells;
    last_ = grid.cells - first;
    for (int i = 0; i < blockCorners; ++i) {
        const Vec3f at = grid.corner(first.x + i, first.y + i, first.z + i);
        for (int axis = 0; axis < 3; ++axis) coordinates_[axis][i] = at[axis];
    }

    std::array<CellRange, bricksPerBlock> cells;
    std::array<Box3f, bricksPerBlock> boxes;
    std::array<int, bricksPerBlock> numbers;
    size_t n = 0;
    for (int b = 0; b < bricksPerBlock; ++b) {
        cells[n] = cellsOf(block.index * bricksAlong + brickAt(b), brickCells, grid);
        if (cells[n].empty()) continue;
        boxes[n] = boxOf(cells[n], grid);
        numbers[n++] = b;
    }
    std::array<eval::Range, bricksPerBlock> ranges;
    eval::evaluateRanges(block.tape, {boxes.data(), n}, ranges.data(), workspace);
    counts.intervalEvaluations += n;
    active_ = 0;
    for (size_t i = 0; i < n; ++i) {
        if (!mayHoldSurface(ranges[i], cells[i], grid)) continue;
        active_ |= 1ull << numbers[i];
        region_[numbers[i]] = static_cast<uint8_t>(i);
    }
}

void BlockSamples::gather(Vec3i brick) {
    const Vec3i first = brick * brickCells;
    const Vec3i corners = min(Vec3i{brickCorners, brickCorners, brickCorners}, last_ + Vec3i{1, 1, 1} - first);
    const uint8_t below = sampledBelow(active_, brick);
    points_ = rowCount_ = 0;
    for (int k = 0; k < corners.z; ++k)
        for (int j = 0; j < corners.y; ++j) {
            const int low = (j == 0 ? 2 : 0) | (k == 0 ? 4 : 0);
            if (below >> low & 1) continue;
            const int skip = below >> (low | 1) & 1, count = corners.x - skip;
            const Vec3i at = first + Vec3i{skip, j, k};
            rows_[rowCount_++] = {static_cast<uint16_t>(cornerNumber(at.x, at.y, at.z)), static_cast<uint8_t>(at.x),
                                  static_cast<uint8_t>(at.y), static_cast<uint8_t>(at.z), static_cast<uint8_t>(count)};
            points_ += static_cast<size_t>(count);
        }
    brickLoops().gather(rows_.data(), rowCount_, coordinates(0), coordinates(1), coordinates(2), x_.data(), y_.data(),
                        z_.data());
}

void BlockSamples::sealBorder(Vec3i brick) {
    const Vec3i first = brick * brickCells;
    if (minComponent(block_->index * blockCells + first) > 0 && minComponent(last_ - first) > brickCells) return;
    for (int k = first.z; k <= first.z + brickCells; ++k)
        for (int j = first.y; j <= first.y + brickCells; ++j)
            for (int i = first.x; i <= first.x + brickCells; ++i) {
                float& f = values_[cornerNumber(i, j, k)];
                const Vec3i global = block_->index * blockCells + Vec3i{i, j, k}, toEnd = last_ - Vec3i{i, j, k};
                if (minComponent(toEnd) < 0)
                    f = 0;
                else if (minComponent(global) == 0 || minComponent(toEnd) == 0)
                    f = std::max(0.0f, f);
            }
}

const eval::Tape& BlockSamples::sample(int brick, eval::Workspace& workspace, Counts& counts) {
    const bool whole = block_->tape.size() <= shortEnough;
    if (!whole) eval::shorten(block_->tape, region_[brick], workspace, tape_, care_);
    const eval::Tape& tape = whole ? block_->tape : tape_;
    gather(brickAt(brick));
    eval::evaluate(tape, {x_.data(), y_.data(), z_.data(), points_}, f_.data(), workspace);
    counts.pointEvaluations += points_;
    brickLoops().scatter(rows_.data(), rowCount_, f_.data(), values_.data());
    sealBorder(brickAt(brick));
    return tape;
}

}  // namespace sgm::mesh
