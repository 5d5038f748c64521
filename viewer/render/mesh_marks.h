// What a mesh says of its own shape: smooth pieces and hard edges.
// Enters: a mesh with labels and corner normals. Leaves: a number a triangle, a segment an edge. Assumes the mesh's
// promises (mesh.h).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/mesh/corners.h"

namespace sgm::render {

/// The ends of an edge, metres.
using Segment = std::array<Vec3f, 2>;

/// Numbers the smooth pieces of a mesh, by triangle: connected triangles of one origin and label, in the order of their
/// first triangles. A mesh without labels has a piece a connected surface of an origin. O(triangles).
std::vector<uint32_t> numberSmoothPieces(const mesh::Mesh& mesh, std::span<const mesh::Triangle> neighbours);

/// The edges at whose ends the triangles on both sides have different normals, each once. `triangles` are the mesh's,
/// with corners counted in the whole mesh, and `neighbours` those of findEdgeNeighbours. O(triangles).
std::vector<Segment> findHardEdges(std::span<const Vec3f> positions, std::span<const mesh::Triangle> triangles,
                                   std::span<const mesh::Triangle> neighbours, const mesh::CornerNormalTable& corners);

}  // namespace sgm::render
