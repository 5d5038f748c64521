// The mesh every writer takes: indexed triangles in chunks, one chunk a block of 32³ cells.
// Enters: chunks from polygonize. Leaves: vertices, normals, triangles, origins. Assumes chunks in ascending block
// order; vertex indices are global: chunk c owns [firstVertex, firstVertex + positions.size()).
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"

namespace sgm::mesh {

/// Corner indices into the whole mesh, counter-clockwise seen from outside.
using Triangle = Vec3<uint32_t>;

/// What one block contributes.
struct Chunk {
    Vec3i block;                   ///< block coordinates in the grid
    uint32_t firstVertex = 0;      ///< global index of positions[0]
    std::vector<Vec3f> positions;  ///< metres, object frame
    std::vector<Vec3f> normals;    ///< unit, outward, from the field's derivative
    std::vector<Triangle> triangles;
    std::vector<OriginId> origins;  ///< one per triangle
};

struct Mesh {
    std::vector<Chunk> chunks;

    size_t vertexCount() const {
        size_t n = 0;
        for (const Chunk& c : chunks) n += c.positions.size();
        return n;
    }
    size_t triangleCount() const {
        size_t n = 0;
        for (const Chunk& c : chunks) n += c.triangles.size();
        return n;
    }
    Box3f bounds() const {
        Box3f box;
        for (const Chunk& c : chunks)
            for (const Vec3f& p : c.positions) box = hull(box, p);
        return box;
    }
};

}  // namespace sgm::mesh
