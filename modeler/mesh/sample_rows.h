// A block's corners and bricks by number, and which corners a brick has to evaluate.
// Enters: a brick, the active ones. Leaves: rows of corners. Assumes bricks are sampled in ascending order.
#pragma once

#include <array>

#include "modeler/eval/evaluate.h"
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
/// To the next corner along an axis.
constexpr Vec3i stepAlong(int axis) { return {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0}; }
constexpr Vec3i cornerIndices(int number) {
    return {number % blockCorners, number / blockCorners % blockCorners, number / (blockCorners * blockCorners)};
}

/// A brick's number in its block, its coordinates there and its low corner's number.
constexpr int brickNumber(Vec3i at) { return at.x + bricksAlong * (at.y + bricksAlong * at.z); }
constexpr Vec3i brickAt(int number) {
    return {number % bricksAlong, number / bricksAlong % bricksAlong, number / (bricksAlong * bricksAlong)};
}
constexpr int brickCorner(Vec3i brick) {
    return cornerNumber(brick.x * brickCells, brick.y * brickCells, brick.z * brickCells);
}

/// Corners that a brick has to evaluate.
struct SampleRows {
    std::array<CornerRow, brickCorners * brickCorners> rows;
    size_t count = 0, points = 0;
    /// Those of a brick of so many corners in a block of `along` along an edge, but for those on low sides that `below`
    /// names, see sampledBelow.
    void list(Vec3i corners, uint8_t below, int along = blockCorners);
};

/// Which of a brick's low faces, edges and corner a lower one of `bricks` has sampled: bit d (x = 1, y = 2, z = 4) is
/// set when a corner on the low sides d lies on the high sides of one of them.
uint8_t sampledBelow(uint64_t bricks, int brick);

/// Points to be evaluated together, up to n of them.
template <size_t n>
struct PointRows {
    static constexpr size_t room = (n + eval::pointPadding - 1) / eval::pointPadding * eval::pointPadding + rowPadding;
    alignas(64) std::array<float, room> x, y, z;

    /// The field at the first `count` ≥ 1 points; `out` as the rows, aligned and with room for whole vectors.
    void evaluate(const eval::Tape& tape, size_t count, float* out, eval::Workspace& workspace) {
        for (float* const row : {x.data(), y.data(), z.data()})
            for (size_t i = count; i % eval::pointPadding != 0; ++i) row[i] = row[count - 1];
        eval::evaluate(tape, {x.data(), y.data(), z.data(), count, true}, out, workspace);
    }
};

}  // namespace sgm::mesh
