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
/// Rows, with room for reading the row above the last one.
inline constexpr int paddedRows = 96;
/// Row j + 9 k, bit i.
using BitRows = std::array<uint16_t, paddedRows>;

/// Coordinates of a row.
constexpr int rowJ(int row) { return row % brickCorners; }
constexpr int rowK(int row) { return row / brickCorners; }

/// Which corners of a brick have f < 0.
struct BrickSigns {
    BitRows rows{};
    std::array<uint8_t, paddedRows> low, high;  ///< bits 0 … 7 and 1 … 8 of each row

    /// `corner` is the block's sample at the brick's low corner.
    explicit BrickSigns(const float* corner);
};

/// The cells that hold surface: bit i + 8 j of word k is cell (i, j, k).
BitCube surfaceCells(const BrickSigns& signs);

/// The edges along `axis` that the surface cuts and the brick owns: bit i + 8 j of word k is the edge up from corner
/// (i, j, k) + firstOwn(axis).
BitCube ownCuts(const BrickSigns& signs, int axis);
constexpr Vec3i firstOwn(int axis) { return {axis == 0 ? 0 : 1, axis == 1 ? 0 : 1, axis == 2 ? 0 : 1}; }

/// Cut edges on the sides of the block that a brick touches, by their low corners. `sides` is a mask of axes. On low
/// sides: those that other blocks own and no lower brick takes care of. On high sides: own ones.
BitRows cutsOnLowSides(const BrickSigns& signs, int axis, int sides);
BitRows cutsOnHighSides(const BrickSigns& signs, int axis, int sides);

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
