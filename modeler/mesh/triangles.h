// Triangles of a block, their vertices numbered across the whole mesh.
// Enters: every block's bricks. Leaves: triangles and origins of one block. Assumes all bricks with surface are there:
// an edge that the surface cuts is cut in every brick around it, so the brick that owns the vertex exists.
#pragma once

#include <vector>

#include "modeler/mesh/brick.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// What a block keeps between finding vertices and joining them.
struct BlockSurface {
    Vec3i index;
    std::vector<Brick> bricks;                      ///< with surface, by number
    std::array<uint8_t, bricksPerBlock> brickOf{};  ///< 1 + place in `bricks`, 0 for none
    std::vector<OriginId> vertexOrigins;            ///< empty: nobody's
    uint32_t firstVertex = 0;                       ///< in the mesh
    uint32_t vertices = 0, triangles = 0;
};

/// The block at `index` among blocks in order of (z, y, x); null where there is none.
const BlockSurface* findBlock(const std::vector<BlockSurface>& blocks, Vec3i index);

/// One worker's scratch: numbers (and origins) of the vertices on a brick's grid edges, by axis, k, j, i.
struct BrickVertices {
    static constexpr int corners = brickCorners * brickCorners * brickCorners;
    std::array<uint32_t, 3 * corners> index;
    std::array<OriginId, 3 * corners> origin;
    std::vector<Triangle> triangles;
    std::vector<OriginId> origins;
};

/// Replaces the scratch's triangles and origins by those of `block`, one of `blocks`. A triangle takes the origin of
/// most of its vertices, the lowest where all three differ.
void joinVertices(const BlockSurface& block, const std::vector<BlockSurface>& blocks, BrickVertices& scratch);

}  // namespace sgm::mesh
