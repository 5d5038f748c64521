#include "modeler/mesh/flat_mesh.h"

#include <algorithm>
#include <iterator>

#include <cstring>

#include "modeler/core/parallel.h"

namespace sgm::mesh {

FlatMesh flatten(const Mesh& mesh, int threads) {
    FlatMesh flat;
    uint32_t vertices = 0, triangles = 0;
    for (const Chunk& c : mesh.chunks) {
        flat.parts.push_back({vertices, static_cast<uint32_t>(c.positions.size()), triangles,
                              static_cast<uint32_t>(c.triangles.size())});
        vertices += flat.parts.back().vertices, triangles += flat.parts.back().triangles;
    }
    flat.positions.resize(vertices);
    flat.triangles.resize(triangles);
    flat.keys.resize(triangles);
    parallelFor(mesh.chunks.size(), threads, nullptr, [&](size_t i, int) {
        const Chunk& c = mesh.chunks[i];
        const FlatMesh::Part& part = flat.parts[i];
        if (part.vertices > 0)
            std::memcpy(flat.positions.data() + part.firstVertex, c.positions.data(), part.vertices * sizeof(Vec3f));
        const bool hasOrigins = c.origins.size() == c.triangles.size(),
                   hasLabels = c.labels.size() == c.triangles.size();
        for (uint32_t t = 0; t < part.triangles; ++t) {
            flat.triangles[part.firstTriangle + t] = c.inMesh(c.triangles[t]);
            flat.keys[part.firstTriangle + t] =
                static_cast<uint64_t>(hasOrigins ? c.origins[t] : 0) << 32 | (hasLabels ? c.labels[t] : 0);
        }
    });
    return flat;
}

Vec3f normalOfVertex(const Mesh& mesh, const FlatMesh& flat, uint32_t vertex) {
    const auto isBefore = [](uint32_t v, const FlatMesh::Part& p) { return v < p.firstVertex; };
    const auto part = std::prev(std::upper_bound(flat.parts.begin(), flat.parts.end(), vertex, isBefore));
    return mesh.chunks[static_cast<size_t>(part - flat.parts.begin())].normals[vertex - part->firstVertex];
}

}  // namespace sgm::mesh
