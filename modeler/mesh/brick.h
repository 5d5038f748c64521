// A brick's surface as bits: which corners are inside, which grid edges and cells the surface crosses.
// Enters: samples. Leaves: bits, 64 a word, so that a whole brick takes a few operations. Assumes the brick's corners
// were sampled. A vertex belongs to the lowest brick that touches its grid edge; so a brick owns 8³ edges along each
// axis, those that don't lie on its low sides.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "modeler/mesh/sample.h"

namespace sgm::mesh {

inline constexpr int brickRows = brickCorners * brickCorners;
/// Rows, with room for whole vectors and the rows above them.
inline constexpr int paddedRows = 112;
static_assert(paddedRows >= cutRows + brickCorners);
/// Row j + 9 k, bit i.
using BitRows = std::array<uint16_t, paddedRows>;

/// Coordinates of a row.
constexpr int rowJ(int row) { return row % brickCorners; }
constexpr int rowK(int row) { return row / brickCorners; }

/// Which corners of a brick have f < 0.
struct BrickSigns {
    BitRows rows;
    std::array<uint8_t, paddedRows> low, high;  ///< bits 0 … 7 and 1 … 8 of each row

    explicit BrickSigns(const BrickValues& values);
};

/// Rows of bits, and which groups of four rows have any.
struct SparseRows {
    BitRows rows;
    uint32_t groups = 0;
};

/// Cut edges on the sides of the block that a brick touches, by their low corners. `sides` is a mask of axes. On low
/// sides: those that other blocks own and no lower brick takes care of. On high sides: own ones.
SparseRows cutsOnLowSides(const BrickSigns& signs, int axis, int sides);
SparseRows cutsOnHighSides(const BrickSigns& signs, int axis, int sides);

/// Calls visit(row, i) for each bit set, ascending.
template <class Visit>
void forEachBit(const SparseRows& sparse, Visit&& visit) {
    static_assert(std::endian::native == std::endian::little);
    constexpr int rowsAWord = 4, bitsARow = 16;
    for (uint32_t groups = sparse.groups; groups != 0; groups &= groups - 1) {
        const int first = rowsAWord * std::countr_zero(groups);
        uint64_t word;
        std::memcpy(&word, sparse.rows.data() + first, sizeof word);
        for (; word != 0; word &= word - 1) {
            const int bit = std::countr_zero(word);
            visit(first + bit / bitsARow, bit % bitsARow);
        }
    }
}

}  // namespace sgm::mesh
