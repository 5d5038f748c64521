#include "modeler/mesh/fanned_mesh.h"

#include <unordered_set>

#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

/// Exchanges what fans replace for their triangles: `fans` has them by triangle, null where there is none.
void replaceTriangles(Chunk& chunk, const std::vector<const TipTriangle*>& fans, const std::vector<bool>& isRemoved) {
    std::vector<CornerNormal> normals;
    uint32_t left = 0;
    visitTriangles(chunk, [&](uint32_t t, std::span<const CornerNormal> own) {
        const TipTriangle* const fan = fans[t];
        if (isRemoved[t] && !fan) return;
        chunk.triangles[left] = fan ? fan->corners : chunk.triangles[t];
        chunk.origins[left] = chunk.origins[t];
        if (!chunk.labels.empty()) chunk.labels[left] = chunk.labels[t];
        if (fan) {
            for (uint32_t k = 0; k < 3; ++k)
                if (fan->ownNormals >> k & 1) normals.push_back({3 * left + k, fan->normals[k]});
        } else {
            for (const CornerNormal& n : own) normals.push_back({3 * left + n.corner % 3, n.normal});
        }
        ++left;
    });
    chunk.triangles.resize(left), chunk.origins.resize(left);
    if (!chunk.labels.empty()) chunk.labels.resize(left);
    chunk.cornerNormals = std::move(normals);
}

}  // namespace

Mesh withFans(const Mesh& mesh, std::span<const TipFan> fans) {
    Chunk chunk = joinChunks(mesh);
    std::vector<const TipTriangle*> fanAt(chunk.triangles.size(), nullptr);
    std::vector<bool> isRemoved(chunk.triangles.size());
    std::unordered_set<uint32_t> tops;
    for (const TipFan& fan : fans) {
        tops.insert(fan.top);
        for (const uint32_t t : fan.removed) isRemoved[t] = true;
        for (const TipTriangle& t : fan.triangles) fanAt[t.number] = &t;
        chunk.positions[fan.top] = fan.apex;
    }
    std::erase_if(chunk.confined, [&](const ConfinedVertex& v) { return tops.contains(v.vertex); });
    replaceTriangles(chunk, fanAt, isRemoved);
    dropUnusedVertices(chunk);
    Mesh made;
    made.chunks.push_back(std::move(chunk));
    return made;
}

}  // namespace sgm::mesh
