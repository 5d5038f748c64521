// What marching cubes found in a block, for what splits and merges its cells.
#pragma once

#include <span>

#include "modeler/mesh/brick_loops.h"
#include "modeler/mesh/marching_cubes.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/piece_samples.h"
#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {

/// The surface of a block. Vertices are own ones by number, then ghosts.
struct BlockSurface {
    const Block* block;
    BlockTapes tapes;
    const Grid* grid;
    std::span<const SurfaceCell> cells;
    const uint32_t* number;  ///< of the vertex on an edge, by 3 · corner + axis
    uint32_t own;            ///< vertices of the block
    std::span<const Vec3f> positions, normals;
    std::span<const uint32_t> labels;
    std::span<const OriginId> origins;
    std::span<const Triangle> triangles;  ///< cell by cell

    /// A corner's place in the lists.
    uint32_t placeOf(uint32_t corner) const { return corner & ghostBit ? own + (corner & ~ghostBit) : corner; }
    /// The vertex on the edge along an axis at a corner, as triangles name it.
    uint32_t vertexAt(Vec3i corner, int axis) const {
        return number[3 * cornerNumber(corner.x, corner.y, corner.z) + axis];
    }
    /// The same of an edge of the cell at `low`.
    uint32_t vertexOf(Vec3i low, int edge) const {
        const int corner = edgeCorner(edge);
        return vertexAt(low + Vec3i{corner & 1, corner >> 1 & 1, corner >> 2}, edgeAxis(edge));
    }
};

}  // namespace sgm::mesh
