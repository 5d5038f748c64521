#include "modeler/mesh/tip_mesh.h"

#include <algorithm>

namespace sgm::mesh {

TipMesh::TipMesh(const Mesh& mesh, int threads, Progress* progress)
    : mesh_(mesh), threads_(threads), progress_(progress) {
    size_t vertices = 0;
    uint32_t triangles = 0;
    for (const Chunk& c : mesh_.chunks) {
        firstTriangle_.push_back(triangles);
        vertices += c.positions.size(), triangles += static_cast<uint32_t>(c.triangles.size());
    }
    positions_.resize(vertices), normals_.resize(vertices), isConfined_.resize(vertices);
    inChunks([&](size_t c) {
        const Chunk& chunk = mesh_.chunks[c];
        std::copy(chunk.positions.begin(), chunk.positions.end(), positions_.begin() + chunk.firstVertex);
        std::copy(chunk.normals.begin(), chunk.normals.end(), normals_.begin() + chunk.firstVertex);
    });
    for (const Chunk& c : mesh_.chunks)
        for (const ConfinedVertex& v : c.confined) isConfined_[c.firstVertex + v.vertex] = true;
}

TipTriangle TipMesh::triangleAt(size_t c, uint32_t t) const {
    const Chunk& chunk = mesh_.chunks[c];
    const Triangle corners = chunk.inMesh(chunk.triangles[t]);
    TipTriangle at{corners,
                   {normals_[corners.x], normals_[corners.y], normals_[corners.z]},
                   firstTriangle_[c] + t,
                   chunk.origins[t],
                   chunk.labels.empty() ? 0 : chunk.labels[t],
                   0};
    for (const CornerNormal& n : cornerNormalsOf(chunk, t)) {
        at.normals[n.corner % 3] = n.normal;
        at.ownNormals |= static_cast<uint8_t>(1u << n.corner % 3);
    }
    return at;
}

void TipMesh::findBoxesOfRuns() {
    if (!boxesOfRuns_.empty()) return;
    boxesOfRuns_.resize(mesh_.chunks.size());
    parallelFor(mesh_.chunks.size(), threads_, progress_, [&](size_t c, int) {
        const Chunk& chunk = mesh_.chunks[c];
        boxesOfRuns_[c].resize((chunk.triangles.size() + runLength - 1) / runLength);
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            Box3f& run = boxesOfRuns_[c][t / runLength];
            run = hull(run, boxOf(positions_, chunk.inMesh(chunk.triangles[t])));
        }
    });
}

std::vector<TipTriangle> TipMesh::trianglesIn(const BoxFinder& finder) {
    findBoxesOfRuns();
    return trianglesOf([&](size_t c, std::vector<uint32_t>& numbers) {
        const Chunk& chunk = mesh_.chunks[c];
        for (size_t run = 0; run < boxesOfRuns_[c].size(); ++run) {
            if (!finder.mayMeet(boxesOfRuns_[c][run])) continue;
            finder.visitMeeting(
                positions_, run * runLength, std::min((run + 1) * runLength, chunk.triangles.size()),
                [&](size_t t) { return chunk.inMesh(chunk.triangles[t]); },
                [&](size_t t, std::span<const uint32_t>) { numbers.push_back(static_cast<uint32_t>(t)); });
        }
    });
}

}  // namespace sgm::mesh
