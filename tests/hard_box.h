// Boxes with hard edges, as a mesher that knows creases makes them: a label a face, and its normal at each corner.
#pragma once

#include <array>

#include "modeler/mesh/mesh.h"

namespace sgm {

/// The faces of a box +x −x +y −y +z −z, two triangles each; corner v of it lies at the signs of v's bits 0 (x), 1 (y)
/// and 2 (z).
inline constexpr std::array<std::array<uint32_t, 4>, 6> boxFaces{
    {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

/// A box of 12 triangles over 8 vertices. Its vertices' own normals point along its diagonals.
inline mesh::Chunk hardBox(Vec3d centre, Mat3 axes, Vec3d half, OriginId origin) {
    mesh::Chunk box;
    for (uint32_t v = 0; v < 8; ++v) {
        const Vec3d signs{v & 1 ? 1.0 : -1.0, v & 2 ? 1.0 : -1.0, v & 4 ? 1.0 : -1.0};
        box.positions.push_back((centre + axes * (signs * half)).as<float>());
        box.normals.push_back((axes * normalized(signs)).as<float>());
    }
    const Vec3d normals[] = {axes.x, -axes.x, axes.y, -axes.y, axes.z, -axes.z};
    for (uint32_t face = 0; face < 6; ++face) {
        const auto [a, b, c, d] = boxFaces[face];
        for (const mesh::Triangle t : {mesh::Triangle{a, b, c}, mesh::Triangle{a, c, d}}) {
            const auto first = static_cast<uint32_t>(3 * box.triangles.size());
            for (uint32_t k = 0; k < 3; ++k) box.cornerNormals.push_back({first + k, normals[face].as<float>()});
            box.triangles.push_back(t);
            box.origins.push_back(origin);
            box.labels.push_back(face);
        }
    }
    return box;
}

/// A mesh of chunks that share no vertex.
inline mesh::Mesh meshOfChunks(std::vector<mesh::Chunk> chunks) {
    mesh::Mesh mesh;
    uint32_t next = 0;
    for (mesh::Chunk& c : chunks) {
        c.block = {static_cast<int>(mesh.chunks.size()), 0, 0};
        c.firstVertex = next;
        next += static_cast<uint32_t>(c.positions.size());
        mesh.chunks.push_back(std::move(c));
    }
    return mesh;
}

}  // namespace sgm
