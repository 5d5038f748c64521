// Chunks to a mesh: their vertices counted across it, and normals that only their triangles can tell.
#include <algorithm>
#include <cassert>
#include <limits>

#include "modeler/core/parallel.h"
#include "modeler/mesh/chunk.h"

namespace sgm::mesh {
namespace {

/// GhostVertex vertices that are sooner named than a thread comes.
constexpr size_t worthAThread = 75000;

/// The chunk of block `index`, among chunks in order of (z, y, x); null where there is none.
const Chunk* findChunk(std::span<const Chunk> chunks, Vec3i index) {
    const auto at = std::lower_bound(chunks.begin(), chunks.end(), index,
                                     [](const Chunk& c, Vec3i i) { return zyxLess(c.block, i); });
    return at != chunks.end() && at->block == index ? &*at : nullptr;
}

}  // namespace

const Chunk& ownerOf(std::span<const Chunk> chunks, uint32_t vertex) {
    const auto after = [](uint32_t v, const Chunk& c) { return v < c.firstVertex; };
    return *std::prev(std::upper_bound(chunks.begin(), chunks.end(), vertex, after));
}

void numberGhosts(std::span<const Chunk> chunks, Chunk& chunk) {
    for (int kind = 0; kind < seamKinds; ++kind) {
        const uint32_t begin = chunk.ghosts.begin[kind], end = chunk.ghosts.begin[kind + 1];
        if (begin == end) continue;
        const int sides = sidesOfSeam(kind);
        const Chunk* const owner = findChunk(chunks, chunk.block - Vec3i{sides & 1, sides >> 1 & 1, sides >> 2});
        assert(owner && owner->shared.begin[kind + 1] - owner->shared.begin[kind] == end - begin);
        const uint32_t* const shared = owner->shared.vertices.data() + owner->shared.begin[kind];
        for (uint32_t i = begin; i < end; ++i) chunk.ghosts.vertices[i] = owner->firstVertex + shared[i - begin];
    }
}

void setFacetedNormals(std::span<const Chunk> chunks, std::span<Chunk> of) {
    std::vector<uint32_t> faceted;  // in the mesh, ascending
    for (const Chunk& c : of)
        for (const uint32_t v : c.faceted) faceted.push_back(c.firstVertex + v);
    if (faceted.empty()) return;

    const auto after = [](uint32_t v, const Chunk& c) { return v < c.firstVertex; };
    const auto position = [&](uint32_t v) {
        const Chunk& c = ownerOf(chunks, v);
        return c.positions[v - c.firstVertex].as<double>();
    };
    std::vector<Vec3d> sums(faceted.size());
    for (const Chunk& c : chunks)
        for (const Triangle& local : c.triangles) {
            const Triangle t = c.inMesh(local);
            for (int corner = 0; corner < 3; ++corner) {
                const auto at = std::lower_bound(faceted.begin(), faceted.end(), t[corner]);
                if (at == faceted.end() || *at != t[corner]) continue;
                const Vec3d p = position(t.x);
                sums[static_cast<size_t>(at - faceted.begin())] += cross(position(t.y) - p, position(t.z) - p);
            }
        }
    for (size_t i = 0; i < faceted.size(); ++i) {
        const Vec3d n = normalized(sums[i]);
        Chunk& c = *std::prev(std::upper_bound(of.begin(), of.end(), faceted[i], after));
        c.normals[faceted[i] - c.firstVertex] = n == Vec3d{} ? Vec3f{0, 1, 0} : n.as<float>();
    }
}

Status Numbering::add(std::span<Chunk> chunks) {
    for (Chunk& c : chunks) {
        c.firstVertex = static_cast<uint32_t>(vertices);
        vertices += c.positions.size();
        triangles += c.triangles.size();
        if (std::max(vertices, triangles) >= std::numeric_limits<uint32_t>::max())
            return Error{Error::Kind::Budget, "the mesh has more than 2^32 vertices or triangles: choose larger cells"};
    }
    return Done{};
}

Status link(std::vector<Chunk>& chunks, int threads) {
    Numbering numbering;
    if (Status status = numbering.add(chunks); !status) return status;
    size_t ghosts = 0;
    for (const Chunk& c : chunks) ghosts += c.ghosts.vertices.size();
    parallelFor(chunks.size(), ghosts >= worthAThread ? threads : 1, nullptr,
                [&](size_t i, int) { numberGhosts(chunks, chunks[i]); });
    setFacetedNormals(chunks, chunks);
    return Done{};
}

}  // namespace sgm::mesh
