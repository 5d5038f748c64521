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

/// Whether all bricks may take the block's tape, where `regions` of the trace are: it folds one fractal,
/// and shortening would spare that to none.
bool foldsEverywhere(const eval::Tape& tape, uint64_t regions, const eval::RangeTrace& trace,
                     eval::RelevantRange care) {
    if (tape.size() > notLong) return false;
    size_t fractals = 0, last = 0;
    for (size_t i = 0; i < tape.size(); ++i) {
        const field::OpTraits& row = field::traits(tape.code()[i].op);
        if (!row.foldSteps) continue;
        if (!row.foldsEverywhere) return false;
        ++fractals, last = i;
    }
    const auto n = static_cast<size_t>(std::bit_width(regions));
    return fractals == 1 && n > 0 && (eval::mayLeaveOut(tape, last, n, trace, care) & regions) == 0;
}

/// Rows of bricks that end in the grid, by `sampledBelow`.
const std::array<SampleRows, 256>& fullBricks() {
    static const auto table = [] {
        std::array<SampleRows, 256> all;
        for (int below = 0; below < 256; ++below)
            all[below].list(Vec3i{1, 1, 1} * brickCorners, static_cast<uint8_t>(below), brickCorners);
        return all;
    }();
    return table;
}

/// Whether the corners that lower bricks have are found sooner by evaluating them again: a seventh of all, but then
/// nothing is gathered and scattered.
bool isQuick(const eval::Tape& tape) {
    constexpr size_t quick = 10;
    constexpr uint32_t mostCost = 165;  // of the longest instruction
    const auto slow = [](const eval::Instruction& in) {
        return field::traits(in.op).cost(in.count, in.data) > mostCost;
    };
    return tape.size() <= quick && std::none_of(tape.code().begin(), tape.code().end(), slow);
}

}  // namespace

void BlockSamples::enter(const Block& block, const Grid& grid, eval::Workspace& workspace, Counts& counts) {
    block_ = &block;
    tapes_.inVain = 0, tapes_.whole = 0;
    shortening_.relevant = relevantRangeFor(block.tape, grid);
    const Vec3i first = block.index * blockCells;
    last_ = grid.cells - first;
    for (int i = 0; i < blockCorners; ++i) {
        const Vec3f at = grid.corner(first.x + i, first.y + i, first.z + i);
        for (int axis = 0; axis < 3; ++axis) coordinates_[axis][i] = at[axis];
    }

    // Bricks that have cells, so many along each axis, are regions.
    Vec3i along;
    for (int axis = 0; axis < 3; ++axis)
        along[axis] = std::min(bricksAlong, (last_[axis] + brickCells - 1) / brickCells);
    uint64_t bricks = 0;
    size_t n = 0;
    for (int k = 0; k < along.z; ++k)
        for (int j = 0; j < along.y; ++j)
            for (int i = 0; i < along.x; ++i) {
                const Vec3i low = Vec3i{i, j, k} * brickCells, high = min(low + Vec3i{1, 1, 1} * brickCells, last_);
                const int brick = brickNumber({i, j, k});
                bricks |= 1ull << brick;
                regions_.of[brick] = static_cast<uint8_t>(n);
                regions_.boxes[n++] = {cornerAt(low), cornerAt(high)};
            }
    shortening_.trace.reset();  // its memory is taken again
    shortening_.trace = eval::evaluateRanges(block.tape, {regions_.boxes.data(), n}, regions_.ranges.data(), workspace);
    counts.intervalEvaluations += n;
    active_ = 0;
    uint64_t regions = 0;
    const uint64_t border = onBorder(bricks);
    for (uint64_t rest = bricks & (block.part ? block.part->bricks : ~uint64_t{0}); rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest), region = regions_.of[brick];
        if (!mayHoldSurface(regions_.ranges[region], border >> brick & 1)) continue;
        regions |= 1ull << region;
        active_ |= 1ull << brick;
    }
    useCoarseSampling_ = mesh::isExpensive(block.tape);
    expensive_ = useCoarseSampling_ && std::isfinite(shortening_.relevant.most);
    oneTape_ = expensive_ && foldsEverywhere(block.tape, regions, *shortening_.trace, shortening_.relevant);
    if (!expensive_) {
        wholeBricks_.enter(coordinates_);
        return;
    }
    active_ = coarse_.enter(block, active_, coordinates_, grid.cell_m, workspace, counts) | onBorder(active_);
    if (oneTape_) coarse_.sample(active_, active_, block.tape, coordinates_, last_, values_.data(), workspace, counts);
}

/// Those of the bricks that touch the border of the grid, or end there.
uint64_t BlockSamples::onBorder(uint64_t bricks) const {
    uint64_t some = 0;
    if (minComponent(block_->index) > 0 && minComponent(last_) > blockCells) return some;
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
    if (minComponent(corners) >= brickCorners) return fullBricks()[below];
    cutOff_.list(min(Vec3i{brickCorners, brickCorners, brickCorners}, corners), below, brickCorners);
    return cutOff_;
}

/// Corners on the grid's border are outside at least, those beyond its end 0.
void BlockSamples::sealBorder(int brick) {
    const Vec3i first = brickAt(brick) * brickCells, end = last_ - first;
    if (minComponent(block_->index * blockCells + first) > 0 && minComponent(end) > brickCells) return;
    const BrickValues at = values(brick);
    float* const corners = values_.data() + (at.corner - values_.data());
    const size_t strides[] = {1, at.row, at.layer};
    const auto plane = [&](int axis, int at, auto&& change) {
        const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
        for (int b = 0; b < brickCorners; ++b) {
            float* const row = corners + static_cast<size_t>(at) * strides[axis] + static_cast<size_t>(b) * strides[v];
            for (size_t a = 0; a < brickCorners; ++a) row[a * strides[u]] = change(row[a * strides[u]]);
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

/// The corners on low sides that lower bricks of the block have.
void BlockSamples::copyFromBelow(int brick) {
    const Vec3i at = brickAt(brick);
    unsigned faces = 0;
    float* const to = values_.data() + brickRoom * brick;
    for (const int offset : {1, 2, 4, 3, 5, 6, 7}) {  // faces hold edges and corners
        const Vec3i by{offset & 1, offset >> 1 & 1, offset >> 2}, other = at - by;
        if (minComponent(other) < 0 || !(active_ >> brickNumber(other) & 1) ||
            (faces & static_cast<unsigned>(offset)) != 0)
            continue;
        if (std::has_single_bit(static_cast<unsigned>(offset))) faces |= static_cast<unsigned>(offset);
        const float* const from = values_.data() + brickRoom * brickNumber(other);
        const auto row = [](int j, int k) { return brickCorners * (j + brickCorners * k); };
        for (int k = 0; k <= (by.z ? 0 : brickCells); ++k)
            for (int j = 0; j <= (by.y ? 0 : brickCells); ++j) {
                const float* const other = from + row(j + by.y * brickCells, k + by.z * brickCells);
                if (by.x)
                    to[row(j, k)] = other[brickCells];
                else
                    std::copy_n(other, brickCorners, to + row(j, k));
            }
    }
}

void WholeBricks::enter(const CornerCoordinates& coordinates) {
    constexpr size_t row = brickCorners, layer = row * row, strides[] = {1, row, layer};
    for (size_t axis = 0; axis < 3; ++axis)
        for (size_t b = 0; b < bricksAlong; ++b) {
            const float* const from = coordinates[axis].data() + b * brickCells;
            std::array<float, room>& at = rows_[axis][b].at;
            bool same = filled_;  // blocks come one after the other
            for (size_t n = 0; n < row && same; ++n) same = at[n * strides[axis]] == from[n];
            if (same) continue;
            for (size_t n = 0; n < row; ++n)
                if (axis == 0)
                    std::copy_n(from, row, at.data() + n * row);
                else
                    std::fill_n(at.data() + n * strides[axis], strides[axis], from[n]);
            for (size_t k = 1; k < row && axis < 2; ++k) std::copy_n(at.data(), layer, at.data() + k * layer);
            std::fill(at.begin() + points, at.end(), at[points - 1]);
        }
    filled_ = true;
}

const eval::Tape& BlockSamples::sample(int brick, eval::Workspace& workspace, Counts& counts) {
    const Vec3i at = brickAt(brick), first = at * brickCells;
    if (oneTape_) {
        tapes_.whole |= 1ull << brick;
        sealBorder(brick);
        return block_->tape;
    }
    const size_t length = block_->tape.size();
    const bool whole = length <= shortEnough || (length <= notLong && tapes_.inVain >= vainEnough);
    eval::Tape& shortened = tapes_.list[tapes_.list.size() == 1 ? 0 : static_cast<size_t>(brick)];
    if (!whole) {
        eval::shorten(block_->tape, *shortening_.trace, regions_.of[brick], workspace, shortened, shortening_.relevant);
        tapes_.inVain = shortened.size() < length ? 0 : tapes_.inVain + 1;
    }
    tapes_.whole |= static_cast<uint64_t>(whole) << brick;
    const eval::Tape& tape = whole ? block_->tape : shortened;
    if (expensive_) {
        coarse_.sample(1ull << brick, active_, tape, coordinates_, last_, values_.data(), workspace, counts);
        sealBorder(brick);
        return tape;
    }
    float* const to = values_.data() + brickRoom * brick;
    if (isQuick(tape)) {
        const eval::Points points = wholeBricks_.of(at);
        eval::evaluate(tape, points, to, workspace);
        counts.pointEvaluations += points.n;
        sealBorder(brick);
        return tape;
    }
    const SampleRows& rows = rowsOf(brick);
    const BrickLoops& loops = brickLoops();
    loops.gather(rows.rows.data(), rows.count, coordinates(0) + first.x, coordinates(1) + first.y,
                 coordinates(2) + first.z, points_.x.data(), points_.y.data(), points_.z.data());
    points_.evaluate(tape, rows.points, f_.data(), workspace);
    counts.pointEvaluations += rows.points;
    loops.scatter(rows.rows.data(), rows.count, f_.data(), to);
    copyFromBelow(brick);
    sealBorder(brick);
    return tape;
}

}  // namespace sgm::mesh
