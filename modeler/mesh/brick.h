// A brick's surface as rows of bits: which corners are inside, which grid edges and cells the surface crosses.
// Enters: samples. Leaves: bits, 16 a row of corners along x, so that whole brick takes a few vector operations.
// Assumes brick corners were sampled. A vertex belongs to the lowest brick that touches its grid edge.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "modeler/mesh/sample.h"

namespace sgm::mesh {

inline constexpr int brickRows = brickCorners * brickCorners;
/// Rows, with room for reading the row above the last one.
inline constexpr int paddedRows = 96;
/// Row j + 9 k, bit i.
using BitRows = std::array<uint16_t, paddedRows>;

/// Coordinates of a row.
constexpr int rowJ(int row) { return row % brickCorners; }
constexpr int rowK(int row) { return row / brickCorners; }

/// Bit i of row (j, k): corner (i, j, k) of the brick has f < 0. `corner` is the sample at its low corner.
BitRows insideRows(const float* corner);

/// The brick's grid edges along `axis` that the surface cuts, by their low corners. Edges on the brick's low sides
/// belong to the brick below, save along the axes in the mask `lowSides`, where there is none in the block.
BitRows cutRows(const BitRows& inside, int axis, int lowSides);

/// The brick's cells that hold surface, by their low corners.
BitRows surfaceRows(const BitRows& inside);

/// The corners of cell (i, row) that are inside, as a case of marching cubes.
inline uint32_t caseOf(const BitRows& inside, int row, int i) {
    const uint32_t a = inside[row], b = inside[row + 1], c = inside[row + brickCorners],
                   d = inside[row + brickCorners + 1];
    return (a >> i & 3) | (b >> i & 3) << 2 | (c >> i & 3) << 4 | (d >> i & 3) << 6;
}

/// Calls visit(row, i) for each bit set, ascending.
template <class Visit>
void forEachBit(const BitRows& rows, Visit&& visit) {
    static_assert(std::endian::native == std::endian::little);
    constexpr int rowsAWord = 4, bitsARow = 16;
    for (int first = 0; first < brickRows; first += rowsAWord) {
        uint64_t word;
        std::memcpy(&word, rows.data() + first, sizeof word);
        for (; word != 0; word &= word - 1) {
            const int bit = std::countr_zero(word);
            visit(first + bit / bitsARow, bit % bitsARow);
        }
    }
}

}  // namespace sgm::mesh
