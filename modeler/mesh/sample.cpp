#include "modeler/mesh/sample.h"

namespace sgm::mesh {
namespace {

constexpr int maxBatch = brickCorners * brickCorners * brickCorners;

/// Below this a shorter tape saves less than making it costs.
constexpr size_t shortEnough = 8;

/// Drops bricks without surface and shortens the block's tape for the others.
void activateBricks(const Block& block, const Grid& grid, eval::Workspace& workspace, BlockSamples& samples,
                    Counts& counts) {
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

    samples.active = 0;
    for (size_t i = 0; i < n; ++i) {
        if (!mayHoldSurface(ranges[i], cells[i], grid)) continue;
        samples.active |= 1ull << numbers[i];
        eval::Tape& tape = samples.tapes[numbers[i]];
        if (block.tape.size() <= shortEnough)
            tape = block.tape;
        else
            eval::shorten(block.tape, i, workspace, tape);
    }
}

/// Which of a brick's high faces, edges and corner a later active brick samples: bit d (x = 1, y = 2, z = 4) is set
/// when a corner on the high sides d lies on the low sides of some active brick.
uint8_t sampledByOthers(uint64_t active, Vec3i brick) {
    uint8_t result = 0;
    for (int offset = 1; offset < 8; ++offset) {
        const Vec3i other = brick + Vec3i{offset & 1, offset >> 1 & 1, offset >> 2};
        if (maxComponent(other) >= bricksAlong || !(active >> brickNumber(other) & 1)) continue;
        for (int d = offset; d < 8; ++d)
            if ((d & offset) == offset) result |= static_cast<uint8_t>(1 << d);
    }
    return result;
}

/// A brick's corners that it has to evaluate, as rows along x of the block's values.
struct Batch {
    struct Row {
        float* values;
        int count;
    };
    std::array<float, maxBatch> x, y, z, f;
    std::array<Row, brickCorners * brickCorners> rows;
    size_t points = 0, rowCount = 0;
};

void gather(Vec3i brick, Vec3i blockIndex, const Grid& grid, BlockSamples& samples, Batch& batch) {
    const Vec3i first = brick * brickCells, global = blockIndex * blockCells + first;
    const Vec3i corners = min(Vec3i{brickCorners, brickCorners, brickCorners}, grid.cells + Vec3i{1, 1, 1} - global);
    const uint8_t byOthers = sampledByOthers(samples.active, brick);
    std::array<float, brickCorners> xs;
    for (int i = 0; i < corners.x; ++i) xs[i] = grid.corner(global.x + i, 0, 0).x;

    batch.points = batch.rowCount = 0;
    for (int k = 0; k < corners.z; ++k)
        for (int j = 0; j < corners.y; ++j) {
            const int high = (j == brickCells ? 2 : 0) | (k == brickCells ? 4 : 0);
            if (byOthers >> high & 1) continue;
            const int count = byOthers >> (high | 1) & 1 ? std::min<int>(corners.x, brickCells) : corners.x;
            const Vec3f at = grid.corner(0, global.y + j, global.z + k);
            for (int i = 0; i < count; ++i) {
                batch.x[batch.points + i] = xs[i];
                batch.y[batch.points + i] = at.y;
                batch.z[batch.points + i] = at.z;
            }
            batch.rows[batch.rowCount++] = {samples.row(first.y + j, first.z + k) + first.x, count};
            batch.points += static_cast<size_t>(count);
        }
}

}  // namespace

bool sampleBlock(const Block& block, const Grid& grid, eval::Workspace& workspace, const Progress* progress,
                 BlockSamples& samples, Counts& counts) {
    activateBricks(block, grid, workspace, samples, counts);
    Batch batch;
    for (uint64_t rest = samples.active; rest != 0; rest &= rest - 1) {
        if (cancelled(progress)) return false;
        const int b = std::countr_zero(rest);
        gather(brickAt(b), block.index, grid, samples, batch);
        eval::evaluate(samples.tapes[b], {batch.x.data(), batch.y.data(), batch.z.data(), batch.points}, batch.f.data(),
                       workspace);
        counts.pointEvaluations += batch.points;
        const float* f = batch.f.data();
        for (size_t r = 0; r < batch.rowCount; f += batch.rows[r++].count)
            std::copy_n(f, batch.rows[r].count, batch.rows[r].values);
    }
    return true;
}

}  // namespace sgm::mesh
