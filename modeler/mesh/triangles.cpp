#include "modeler/mesh/triangles.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

constexpr uint64_t everyBit = ~0ull, lowX = 0x0101010101010101ull, lowY = 0xffull;

constexpr int cornerNumber(int i, int j, int k) { return i + brickCorners * (j + brickCorners * k); }

/// Notes the vertices of `owner` that lie in the brick `offset` (0 or 1 along each axis) below it.
void loadVertices(const BlockSurface& block, const Brick& owner, Vec3i offset, BrickVertices& out) {
    const uint64_t wanted = (offset.x ? lowX : everyBit) & (offset.y ? lowY : everyBit);
    const uint32_t first = block.firstVertex + owner.firstVertex;
    for (int axis = 0; axis < 3; ++axis) {
        if (offset[axis]) continue;  // such edges leave the brick
        for (int k = 0; k < (offset.z ? 1 : slabs); ++k) {
            const int word = axis * slabs + k;
            const uint64_t bits = owner.crossed[word];
            uint32_t next = owner.rank[word];
            for (uint64_t rest = bits & wanted; rest != 0; rest &= rest - 1) {
                const int bit = std::countr_zero(rest);
                // A bit's rank is the number of bits before it: where all are wanted, it counts up.
                const uint32_t rank = wanted == everyBit
                                          ? next++
                                          : next + static_cast<uint32_t>(std::popcount(bits & ((1ull << bit) - 1)));
                const int at = axis * BrickVertices::corners + cornerNumber(bit % brickCells + offset.x * brickCells,
                                                                            bit / brickCells + offset.y * brickCells,
                                                                            k + offset.z * brickCells);
                out.index[at] = first + rank;
                out.origin[at] = block.vertexOrigins.empty() ? 0 : block.vertexOrigins[owner.firstVertex + rank];
            }
        }
    }
}

/// The brick at `at` counted in `block`'s bricks, which may lie in a block above.
void loadNeighbour(const BlockSurface& block, const std::vector<BlockSurface>& blocks, Vec3i at, Vec3i offset,
                   BrickVertices& out) {
    const Vec3i blockOffset{at.x / bricksAlong, at.y / bricksAlong, at.z / bricksAlong};
    const BlockSurface* holder = blockOffset == Vec3i{} ? &block : findBlock(blocks, block.index + blockOffset);
    if (!holder) return;
    const uint8_t place = holder->brickOf[brickNumber(at - blockOffset * bricksAlong)];
    if (place) loadVertices(*holder, holder->bricks[place - 1u], offset, out);
}

OriginId majority(OriginId a, OriginId b, OriginId c) {
    if (a == b || a == c) return a;
    return b == c ? b : std::min({a, b, c});
}

/// Where a cell's edges lie in the scratch, from its low corner's number.
std::array<int, edgesPerCell> edgeOffsets() {
    std::array<int, edgesPerCell> offsets{};
    for (int e = 0; e < edgesPerCell; ++e) {
        const int c = edgeCorner(e);
        offsets[e] = edgeAxis(e) * BrickVertices::corners + cornerNumber(c & 1, c >> 1 & 1, c >> 2);
    }
    return offsets;
}

}  // namespace

const BlockSurface* findBlock(const std::vector<BlockSurface>& blocks, Vec3i index) {
    const auto at = std::lower_bound(blocks.begin(), blocks.end(), index,
                                     [](const BlockSurface& b, Vec3i i) { return zyxLess(b.index, i); });
    return at != blocks.end() && at->index == index ? &*at : nullptr;
}

void joinVertices(const BlockSurface& block, const std::vector<BlockSurface>& blocks, BrickVertices& scratch) {
    const CaseTable& cases = caseTable();
    const std::array<int, edgesPerCell> offsets = edgeOffsets();
    scratch.triangles.resize(block.triangles);
    scratch.origins.resize(block.triangles);
    Triangle* triangle = scratch.triangles.data();
    OriginId* origin = scratch.origins.data();
    for (const Brick& brick : block.bricks) {
        for (int o = 0; o < 7; ++o) {
            const Vec3i offset{o & 1, o >> 1 & 1, o >> 2};
            loadNeighbour(block, blocks, brickAt(brick.number) + offset, offset, scratch);
        }
        forEachSurfaceCell(brick, [&](Vec3i c, uint32_t inside) {
            const CellCase& cell = cases[inside];
            const int base = cornerNumber(c.x, c.y, c.z);
            for (int t = 0; t < cell.triangles; ++t) {
                const int a = base + offsets[cell.edges[3 * t]], b = base + offsets[cell.edges[3 * t + 1]],
                          d = base + offsets[cell.edges[3 * t + 2]];
                *triangle++ = {scratch.index[a], scratch.index[b], scratch.index[d]};
                *origin++ = majority(scratch.origin[a], scratch.origin[b], scratch.origin[d]);
            }
        });
    }
}

}  // namespace sgm::mesh
