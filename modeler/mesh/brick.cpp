#include "modeler/mesh/brick.h"

namespace sgm::mesh {
namespace {

/// Signs of the brick's corners; those on the grid's border or beyond count as outside.
void readSigns(Brick& brick, Vec3i globalCorner, const Grid& grid, const BlockSamples& samples) {
    const Vec3i first = brickAt(brick.number) * brickCells;
    uint32_t within = 0;
    for (int i = 0; i < brickCorners; ++i)
        if (globalCorner.x + i > 0 && globalCorner.x + i < grid.cells.x) within |= 1u << i;
    for (int k = 0; k < brickCorners; ++k) {
        if (globalCorner.z + k <= 0 || globalCorner.z + k >= grid.cells.z) continue;
        for (int j = 0; j < brickCorners; ++j) {
            if (globalCorner.y + j <= 0 || globalCorner.y + j >= grid.cells.y) continue;
            const float* f = samples.row(first.y + j, first.z + k) + first.x;
            uint32_t bits = 0;
            for (int i = 0; i < brickCorners; ++i) bits |= static_cast<uint32_t>(f[i] < 0) << i;
            brick.inside[j + brickCorners * k] = static_cast<uint16_t>(bits & within);
        }
    }
}

void markCrossings(Brick& brick) {
    for (int k = 0; k < brickCells; ++k) {
        uint64_t x = 0, y = 0, z = 0;
        for (int j = 0; j < brickCells; ++j) {
            const uint16_t* row = brick.inside.data() + j + brickCorners * k;
            const uint64_t r = row[0];
            x |= ((r ^ r >> 1) & 0xff) << 8 * j;
            y |= ((r ^ row[1]) & 0xff) << 8 * j;
            z |= ((r ^ row[brickCorners]) & 0xff) << 8 * j;
        }
        brick.crossed[k] = x;
        brick.crossed[slabs + k] = y;
        brick.crossed[2 * slabs + k] = z;
    }
    for (size_t w = 1; w < brick.crossed.size(); ++w)
        brick.rank[w] = static_cast<uint16_t>(brick.rank[w - 1] + std::popcount(brick.crossed[w - 1]));
}

}  // namespace

Brick makeBrick(int number, Vec3i blockIndex, const Grid& grid, const BlockSamples& samples) {
    Brick brick;
    brick.number = static_cast<uint8_t>(number);
    readSigns(brick, blockIndex * blockCells + brickAt(number) * brickCells, grid, samples);
    markCrossings(brick);
    const CaseTable& cases = caseTable();
    forEachSurfaceCell(brick, [&](Vec3i, uint32_t inside) {
        ++brick.cells;
        brick.triangles += cases[inside].triangles;
    });
    return brick;
}

}  // namespace sgm::mesh
