// The triangles of a mesh with the places and normals of their corners.
// Enters: a mesh. Leaves: its triangles in order.
#pragma once

#include <array>
#include <vector>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/corners.h"

namespace sgm::pipeline {

/// A triangle of a mesh.
struct Face {
    mesh::Triangle vertices;
    OriginId origin = 0;
    std::array<Vec3f, 3> places, normals;

    /// Across it, as long as twice its area, m².
    Vec3f across() const { return cross(places[1] - places[0], places[2] - places[0]); }
    Vec3f middle() const { return (places[0] + places[1] + places[2]) * (1.0f / 3); }
};

inline std::vector<Face> facesOf(const mesh::Mesh& mesh) {
    const mesh::CornerNormalTable corners = mesh::collectCornerNormals(mesh);
    std::vector<Vec3f> positions, normals;
    std::vector<Face> faces;
    for (const mesh::Chunk& c : mesh.chunks) {
        positions.insert(positions.end(), c.positions.begin(), c.positions.end());
        normals.insert(normals.end(), c.normals.begin(), c.normals.end());
        for (size_t t = 0; t < c.triangles.size(); ++t)
            faces.push_back({c.inMesh(c.triangles[t]), c.origins.empty() ? OriginId{0} : c.origins[t], {}, {}});
    }
    for (size_t t = 0; t < faces.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = faces[t].vertices[k], own = corners.empty() ? mesh::noIndex : corners.of[t][k];
            faces[t].places[static_cast<size_t>(k)] = positions[v];
            faces[t].normals[static_cast<size_t>(k)] = own == mesh::noIndex ? normals[v] : corners.normals[own];
        }
    return faces;
}

}  // namespace sgm::pipeline
