// Normals at the corners of triangles, and which triangles lie beside each other.
// Enters: a Mesh. Leaves: flat lists over its triangles, counted through all chunks in order. Assumes the mesh's
// promises (mesh.h): each edge has one triangle on either side, or none on one where the surface is open.
#pragma once

#include <span>
#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Says that there is no such index.
inline constexpr uint32_t noIndex = 0xffffffffu;

/// The corner normals of a mesh, equal ones once.
struct CornerNormalTable {
    std::vector<Vec3f> normals;  ///< distinct, in the order of their first corners
    /// By triangle, a corner's index into `normals`, or noIndex where the corner has its vertex's normal. Empty where
    /// no corner of the mesh has a normal of its own.
    std::vector<Triangle> of;

    bool empty() const { return of.empty(); }
};

/// Collects Chunk::cornerNormals of all chunks; those of equal bits become one. O(triangles).
CornerNormalTable collectCornerNormals(const Mesh& mesh);

/// All triangles with corners counted in the whole mesh.
std::vector<Triangle> gatherTriangles(const Mesh& mesh);

/// For each triangle the one across its edges (x, y), (y, z), (z, x), or noIndex. An edge with more than two triangles
/// takes the first that runs along it the other way. Corners are below `vertexCount`. O(triangles).
std::vector<Triangle> findEdgeNeighbours(std::span<const Triangle> triangles, size_t vertexCount);

/// A number for each triangle, from 1 on, such that triangles with an edge between them have equal numbers where their
/// normals agree at both ends of it, and smooth pieces that share a vertex otherwise have different ones: smoothing
/// groups. Numbers are small (greedy colouring). `neighbours` are findEdgeNeighbours'. O(triangles · log).
std::vector<uint32_t> findSmoothingGroups(const Mesh& mesh, std::span<const Triangle> triangles,
                                          const CornerNormalTable& corners, std::span<const Triangle> neighbours);

}  // namespace sgm::mesh
