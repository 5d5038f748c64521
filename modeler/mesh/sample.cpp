#include "modeler/mesh/sample.h"

#include <algorithm>

#include "modeler/eval/left_out.h"
#include "modeler/field/ops.h"

namespace sgm::mesh {
namespace {

/// Up to so many instructions a shorter tape saves less than making it costs.
constexpr size_t shortEnough = 4;
/// A block's tape up to `notLong` is left as it is once so many bricks one after the other needed all of it.
constexpr int vainEnough = 8;
constexpr size_t notLong = 16;

/// Whether all bricks may take the block's tape, where `regions` of the last evaluateRanges are: it folds one fractal,
/// and shortening would spare that to none.
bool foldsEverywhere(const eval::Tape& tape, uint64_t regions, eval::Workspace& workspace, eval::Care care) {
    if (tape.size() > notLong) return false;
    size_t fractals = 0, last = 0;
    for (size_t i = 0; i < tape.size(); ++i) {
        if (tape.code()[i].op == field::codeOf<field::ops::Facade>) return false;
        if (tape.code()[i].op == field::codeOf<field::ops::Kifs>) ++fractals, last = i;
    }
    const auto n = static_cast<size_t>(std::bit_width(regions));
    return fractals == 1 && n > 0 && (eval::mayLeaveOut(tape, last, n, workspace, care) & regions) == 0;
}

/// Rows of whole bricks, by `sampledBelow`.
const std::array<SampleRows, 256>& wholeBricks() {
    static const auto table = [] {
        std::array<SampleRows, 256> all;
        for (int below = 0; below < 256; ++below)
            all[below].list(Vec3i{1, 1, 1} * brickCorners, static_cast<uint8_t>(below));
        return all;
    }();
    return table;
}

}  // namespace

void BlockSamples::enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts) {
    block_ = &block;
    inVain_ = 0;
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
    uint64_t regions = 0;
    for (size_t i = 0; i < n; ++i) {
        if (!mayHoldSurface(ranges[i], cells[i], grid)) continue;
        regions |= 1ull << i;
        active_ |= 1ull << numbers[i];
        region_[numbers[i]] = static_cast<uint8_t>(i);
    }
    dear_ = isDear(block.tape) && std::isfinite(care_.most);
    oneTape_ = dear_ && foldsEverywhere(block.tape, regions, workspace, care_);
    if (!dear_) return;
    active_ = coarse_.enter(block, active_, coordinates_, grid.cell_m, workspace, counts) | onBorder(active_);
    if (oneTape_) coarse_.sample(active_, active_, block.tape, coordinates_, last_, values_.data(), workspace, counts);
}

/// Those of the bricks that touch the border of the grid, or end there.
uint64_t BlockSamples::onBorder(uint64_t bricks) const {
    uint64_t some = 0;
    for (uint64_t rest = bricks; rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest);
        const Vec3i low = brickAt(brick) * brickCells;
        if (minComponent(block_->index * blockCells + low) == 0 || minComponent(last_ - low) <= brickCells)
            some |= 1ull << brick;
    }
    return some;
}

const SampleRows& BlockSamples::rowsOf(int brick) {
    const Vec3i corners = last_ + Vec3i{1, 1, 1} - brickAt(brick) * brickCells;
    const uint8_t below = sampledBelow(active_, brick);
    if (minComponent(corners) >= brickCorners) return wholeBricks()[below];
    cutOff_.list(min(Vec3i{brickCorners, brickCorners, brickCorners}, corners), below);
    return cutOff_;
}

/// Corners on the grid's border are outside at least, those beyond its end 0.
void BlockSamples::sealBorder(Vec3i brick) {
    const Vec3i first = brick * brickCells, end = last_ - first;
    if (minComponent(block_->index * blockCells + first) > 0 && minComponent(end) > brickCells) return;
    float* const values = values_.data() + brickCorner(brick);
    const auto plane = [&](int axis, int at, auto&& change) {
        constexpr int strides[] = {1, blockCorners, blockCorners * blockCorners};
        const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
        for (int b = 0; b < brickCorners; ++b) {
            float* const row = values + at * strides[axis] + b * strides[v];
            for (int a = 0; a < brickCorners; ++a) row[a * strides[u]] = change(row[a * strides[u]]);
        }
    };
    const auto outside = [](float f) { return std::max(0.0f, f); };
    for (int axis = 0; axis < 3; ++axis) {
        if (block_->index[axis] * blockCells + first[axis] == 0) plane(axis, 0, outside);
        if (end[axis] <= brickCells) plane(axis, end[axis], outside);
    }
    for (int axis = 0; axis < 3; ++axis)
        for (int at = end[axis] + 1; at <= brickCells; ++at) plane(axis, at, [](float) { return 0.0f; });
}

const eval::Tape& BlockSamples::sample(int brick, eval::Workspace& workspace, Counts& counts) {
    const Vec3i at = brickAt(brick), first = at * brickCells;
    if (oneTape_) {
        sealBorder(at);
        return block_->tape;
    }
    const size_t length = block_->tape.size();
    const bool whole = length <= shortEnough || (length <= notLong && inVain_ >= vainEnough);
    if (!whole) {
        eval::shorten(block_->tape, region_[brick], workspace, tape_, care_);
        inVain_ = tape_.size() < length ? 0 : inVain_ + 1;
    }
    const eval::Tape& tape = whole ? block_->tape : tape_;
    if (dear_) {
        coarse_.sample(1ull << brick, active_, tape, coordinates_, last_, values_.data(), workspace, counts);
        sealBorder(at);
        return tape;
    }
    const SampleRows& rows = rowsOf(brick);
    const BrickLoops& loops = brickLoops();
    eval::PointRoom to = eval::roomForPoints(tape, rows.points, workspace);
    if (!to.x) to = {x_.data(), y_.data(), z_.data()};
    loops.gather(rows.rows.data(), rows.count, coordinates(0) + first.x, coordinates(1) + first.y,
                 coordinates(2) + first.z, to.x, to.y, to.z);
    eval::evaluate(tape, {to.x, to.y, to.z, rows.points}, f_.data(), workspace);
    counts.pointEvaluations += rows.points;
    loops.scatter(rows.rows.data(), rows.count, f_.data(), values_.data() + brickCorner(at));
    sealBorder(at);
    return tape;
}

}  // namespace sgm::mesh
