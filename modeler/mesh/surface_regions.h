// The regions of a surface: connected triangles of one origin and label, and the edges between them.
// Enters: a flat mesh. Leaves: the region of each triangle and vertex, and the edges where two regions meet. Assumes a
// closed 2-manifold. Components are found over vertices as pixels are labelled (Rosenfeld and Pfaltz, "Sequential
// Operations in Digital Picture Processing", 1966): edges are matched only where regions meet.
#pragma once

#include "modeler/core/result.h"
#include "modeler/mesh/flat_mesh.h"

namespace sgm::mesh {

/// An edge between two regions, from vertex a to b as the triangle of the region `left` runs.
struct BorderEdge {
    uint32_t a, b;
    uint32_t left, right;
};

struct SurfaceRegions {
    /// Set in `ofVertex` where more than one region meets; the rest counts these vertices in ascending order.
    static constexpr uint32_t borderBit = 0x80000000u;

    PageVector<uint32_t> ofTriangle;
    PageVector<uint32_t> ofVertex;         ///< region, or borderBit | place in `borderVertices`
    std::vector<uint64_t> keys;            ///< by region, as FlatMesh::keys; regions count by their first triangles
    std::vector<uint32_t> borderVertices;  ///< ascending
    std::vector<BorderEdge> borders;       ///< each edge once, in an order that depends on the mesh alone

    size_t count() const { return keys.size(); }
    static bool isBorder(uint32_t regionOfVertex) { return (regionOfVertex & borderBit) != 0; }
};

/// O(n), on `threads` threads (0: all). Error::Input for a mesh that isn't closed or isn't a 2-manifold along a border;
/// elsewhere that is not looked at. Error::Budget for 2³¹ vertices or triangles.
Result<SurfaceRegions> findRegions(const FlatMesh& mesh, int threads);

}  // namespace sgm::mesh
