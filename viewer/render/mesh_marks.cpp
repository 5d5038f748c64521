#include "viewer/render/mesh_marks.h"

#include <utility>

namespace sgm::render {
namespace {

using mesh::noIndex;

/// Whether the triangle has at a vertex the normal that `normal` numbers.
bool hasNormal(const mesh::Triangle& vertices, const mesh::Triangle& normals, uint32_t vertex, uint32_t normal) {
    for (int k = 0; k < 3; ++k)
        if (vertices[k] == vertex) return normals[k] == normal;
    return true;
}

}  // namespace

std::vector<uint32_t> numberSmoothPieces(const mesh::Mesh& mesh, std::span<const mesh::Triangle> neighbours) {
    std::vector<std::pair<OriginId, mesh::Label>> keys;
    keys.reserve(neighbours.size());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (size_t t = 0; t < chunk.triangles.size(); ++t)
            keys.emplace_back(chunk.origins[t], chunk.labels.empty() ? 0 : chunk.labels[t]);
    std::vector<uint32_t> pieces(neighbours.size(), noIndex), open;
    uint32_t count = 0;
    for (uint32_t first = 0; first < neighbours.size(); ++first) {
        if (pieces[first] != noIndex) continue;
        pieces[first] = count;
        open.push_back(first);
        while (!open.empty()) {
            const uint32_t t = open.back();
            open.pop_back();
            for (int side = 0; side < 3; ++side) {
                const uint32_t next = neighbours[t][side];
                if (next == noIndex || pieces[next] != noIndex || keys[next] != keys[t]) continue;
                pieces[next] = count;
                open.push_back(next);
            }
        }
        ++count;
    }
    return pieces;
}

std::vector<Segment> findHardEdges(std::span<const Vec3f> positions, std::span<const mesh::Triangle> triangles,
                                   std::span<const mesh::Triangle> neighbours, const mesh::CornerNormalTable& corners) {
    std::vector<Segment> edges;
    if (corners.empty()) return edges;
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (int side = 0; side < 3; ++side) {
            const uint32_t other = neighbours[t][side];
            if (other == noIndex || other < t) continue;
            const uint32_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
            if (hasNormal(triangles[other], corners.of[other], a, corners.of[t][side]) &&
                hasNormal(triangles[other], corners.of[other], b, corners.of[t][(side + 1) % 3]))
                continue;
            edges.push_back({positions[a], positions[b]});
        }
    return edges;
}

}  // namespace sgm::render
