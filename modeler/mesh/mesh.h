// The mesh every writer takes: indexed triangles in chunks, one chunk a block of 32³ cells.
// Enters: chunks from polygonize. Leaves: vertices, normals, triangles, origins. Assumes chunks in ascending block
// order. A chunk numbers its own vertices from 0, so that it stays as it is whatever becomes of the others; vertices on
// a border between blocks belong to the lowest of them, and the others have ghosts of them. A mesh of positions only is
// its shape alone: its chunks have no normals, no origins and no faceted vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"

namespace sgm::mesh {

/// Corner indices, counter-clockwise seen from outside.
using Triangle = Vec3<uint32_t>;

/// Marks a corner that counts in Chunk::ghosts instead of Chunk::positions.
inline constexpr uint32_t ghostBit = 0x80000000u;

/// The ways in which blocks share vertices: first those on grid edges, by the axes along which the lender is one block
/// lower, then those inside cell faces, which lie on one side of a block.
inline constexpr int seamKinds = 9, edgeSeamKinds = 6;
/// The axes along which the lender is one block lower, as a mask (x 1, y 2, z 4).
constexpr int sidesOfSeam(int kind) { return kind < edgeSeamKinds ? kind + 1 : 1 << (kind - edgeSeamKinds); }

/// Lists by the kind of seam, one after the other. Both sides of a seam list its vertices in the same order.
struct SeamList {
    std::array<uint32_t, seamKinds + 1> begin{};  ///< of the kinds; the last one is the end
    std::vector<uint32_t> vertices;
};

/// Names the smooth piece of a part's surface that a triangle lies on: a face of a box, a side of a roof, a blend. Two
/// triangles of equal origin and label that share an edge have no crease between them.
using Label = uint32_t;

/// The normal at one corner of a triangle whose vertex lies on a crease.
struct CornerNormal {
    uint32_t corner;  ///< 3 · triangle + 0 … 2, counted in the chunk
    Vec3f normal;     ///< unit, outward, of the smooth piece that the triangle lies on
};

/// A vertex that was kept inside its cell although its crease or corner lies beyond.
struct ConfinedVertex {
    uint32_t vertex;  ///< an own one of the chunk
    Vec3f place;      ///< metres, where the crease or corner is
};

/// What one block contributes.
struct Chunk {
    Vec3i block;                     ///< block coordinates in the grid
    uint32_t firstVertex = 0;        ///< index of positions[0] in the whole mesh
    PageVector<Vec3f> positions;     ///< metres, object frame
    PageVector<Vec3f> normals;       ///< unit, outward, from the field's derivative; none in a bare mesh
    PageVector<Triangle> triangles;  ///< corners count in this chunk, see `inMesh`
    PageVector<OriginId> origins;    ///< one per triangle; none in a bare mesh
    PageVector<Label> labels;        ///< one per triangle; none where creases were not looked for
    /// Ascending by corner: replace the vertex's normal in `normals` for that corner alone.
    std::vector<CornerNormal> cornerNormals;
    SeamList ghosts;                       ///< indices in the whole mesh of vertices that lower blocks own
    SeamList shared;                       ///< own vertices of which higher blocks have ghosts
    std::vector<ConfinedVertex> confined;  ///< ascending by vertex; see `releaseConfined`
    std::vector<uint32_t> faceted;         ///< own vertices without derivative: their normals come from the triangles

    /// A corner's or a triangle's vertices, counted in the whole mesh.
    uint32_t inMesh(uint32_t corner) const {
        return corner & ghostBit ? ghosts.vertices[corner & ~ghostBit] : firstVertex + corner;
    }
    /// Whether normals or origins are missing.
    bool hasPositionsOnly() const { return normals.size() != positions.size() || origins.size() != triangles.size(); }
    Triangle inMesh(Triangle t) const { return {inMesh(t.x), inMesh(t.y), inMesh(t.z)}; }
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
    /// Whether some chunk's normals or origins are missing.
    bool hasPositionsOnly() const {
        return std::any_of(chunks.begin(), chunks.end(), [](const Chunk& c) { return c.hasPositionsOnly(); });
    }
    Box3f bounds() const {
        Box3f box;
        for (const Chunk& c : chunks)
            for (const Vec3f& p : c.positions) box = hull(box, p);
        return box;
    }
};

}  // namespace sgm::mesh
