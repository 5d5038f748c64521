// A brick's surface as bits: which corners are inside, which of its grid edges the surface crosses.
// Enters: a block's samples. Leaves: 400 bytes that number every vertex without a hash map: a vertex belongs to the
// brick that holds the low corner of its grid edge and is numbered by the rank of its bit there. Assumes brick corners
// were sampled.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "modeler/mesh/marching_cubes.h"
#include "modeler/mesh/sample.h"

namespace sgm::mesh {

inline constexpr int slabs = brickCells;  ///< of 64 corners, one a z

struct Brick {
    std::array<uint16_t, brickCorners * brickCorners> inside{};  ///< row j + 9 k, bit i: corner (i, j, k) has f < 0
    std::array<uint64_t, 3 * slabs> crossed{};  ///< word axis · 8 + k, bit i + 8 j: that grid edge is cut
    std::array<uint16_t, 3 * slabs> rank{};     ///< cut edges in the words before
    uint32_t firstVertex = 0;                   ///< in its block
    uint32_t cells = 0;                         ///< cells with surface
    uint32_t triangles = 0;
    uint8_t number = 0;  ///< in its block

    uint32_t vertices() const { return rank.back() + static_cast<uint32_t>(std::popcount(crossed.back())); }
};

/// Reads the signs of brick `number` and counts what it will hold.
Brick makeBrick(int number, Vec3i blockIndex, const Grid& grid, const BlockSamples& samples);

/// Calls visit(corner, inside) for each cell that holds surface, z, y, x ascending, with its low corner and case.
template <class Visit>
void forEachSurfaceCell(const Brick& brick, Visit&& visit) {
    for (int k = 0; k < brickCells; ++k)
        for (int j = 0; j < brickCells; ++j) {
            const uint16_t* row = brick.inside.data() + j + brickCorners * k;
            const uint32_t r0 = row[0], r1 = row[1], r2 = row[brickCorners], r3 = row[brickCorners + 1];
            const uint32_t any = r0 | r1 | r2 | r3, all = r0 & r1 & r2 & r3;
            uint32_t mixed = (any | any >> 1) & ~(all & all >> 1) & 0xff;
            for (; mixed != 0; mixed &= mixed - 1) {
                const int i = std::countr_zero(mixed);
                const uint32_t inside = (r0 >> i & 3) | (r1 >> i & 3) << 2 | (r2 >> i & 3) << 4 | (r3 >> i & 3) << 6;
                visit(Vec3i{i, j, k}, inside);
            }
        }
}

/// Calls visit(axis, corner) for each grid edge of the brick that the surface cuts, in the order of their vertices.
template <class Visit>
void forEachVertex(const Brick& brick, Visit&& visit) {
    for (int word = 0; word < 3 * slabs; ++word)
        for (uint64_t rest = brick.crossed[word]; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            visit(word / slabs, Vec3i{bit % brickCells, bit / brickCells, word % slabs});
        }
}

}  // namespace sgm::mesh
