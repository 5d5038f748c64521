#include "modeler/export/surface.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>
#include <unordered_map>

namespace sgm::exporter {
namespace {

using mesh::noIndex;

/// What all triangles of one origin have in common.
struct Group {
    uint32_t object, material;
    OriginId origin;
    auto operator<=>(const Group&) const = default;
};

/// The groups of a mesh in the order of patches, and the one of each triangle in mesh order.
struct Groups {
    std::vector<Group> all;
    std::vector<uint32_t> ofTriangle;
};

Groups groupTriangles(const mesh::Mesh& mesh, const Provenance& provenance, const Cut& cut) {
    std::unordered_map<OriginId, uint32_t> known;  // place in `all`
    Groups groups;
    groups.ofTriangle.reserve(mesh.triangleCount());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins) {
            if (!groups.ofTriangle.empty() && groups.all[groups.ofTriangle.back()].origin == origin) {
                groups.ofTriangle.push_back(groups.ofTriangle.back());
                continue;
            }
            const auto [at, fresh] = known.try_emplace(origin, static_cast<uint32_t>(groups.all.size()));
            if (fresh)
                groups.all.push_back(
                    {cut.objects ? cut.objects->nodeOf(origin) : 0, materialIndex(provenance, origin), origin});
            groups.ofTriangle.push_back(at->second);
        }
    std::vector<uint32_t> sorted(groups.all.size()), place(groups.all.size());
    std::iota(sorted.begin(), sorted.end(), 0u);
    const auto key = [&](uint32_t i) {
        Group g = groups.all[i];
        if (!cut.byMaterial) g.material = 0;
        return g;
    };
    std::sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    std::vector<Group> all;
    for (const uint32_t i : sorted) place[i] = static_cast<uint32_t>(all.size()), all.push_back(groups.all[i]);
    for (uint32_t& g : groups.ofTriangle) g = place[g];
    groups.all = std::move(all);
    return groups;
}

/// Counting sort of the mesh's triangles by group; fills the patches' triangle ranges.
void sortTriangles(const mesh::Mesh& mesh, const Groups& groups, bool byMaterial, PatchedMesh& out) {
    std::vector<uint32_t> next(groups.all.size() + 1, 0);
    for (const uint32_t g : groups.ofTriangle) ++next[g + 1];
    for (uint32_t g = 0; g < groups.all.size(); ++g) {
        const Group& group = groups.all[g];
        const bool fresh = out.patches.empty() || out.patches.back().object != group.object ||
                           (byMaterial && out.patches.back().material != group.material);
        if (fresh) out.patches.push_back({group.object, group.material, 0, 0, next[g], 0});
        out.patches.back().triangleCount += next[g + 1];
        next[g + 1] += next[g];
    }
    out.triangles.resize(groups.ofTriangle.size());
    out.origins.resize(groups.ofTriangle.size());
    out.order.resize(groups.ofTriangle.size());
    uint32_t i = 0;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const mesh::Triangle& t : chunk.triangles) {
            const uint32_t group = groups.ofTriangle[i], at = next[group]++;
            out.triangles[at] = chunk.inMesh(t);
            out.origins[at] = groups.all[group].origin;
            out.order[at] = i++;
        }
}

/// Floats the vertices of patches, one for each mesh vertex, chart, material and normal in a patch, in the order of
/// their first corners.
class VertexCutter {
public:
    VertexCutter(size_t meshVertices, const Provenance& provenance, const Cut& cut, PatchedMesh& out)
        : provenance_(provenance), charts_(cut.charts), out_(out), newest_(meshVertices, noIndex) {
        for (auto* list : {&out_.vertices, &out_.materials, &out_.charts, &older_}) list->reserve(meshVertices);
    }
    void cut(Patch& patch) {
        patch.firstVertex = static_cast<uint32_t>(out_.vertices.size());
        for (uint32_t t = patch.firstTriangle; t < patch.firstTriangle + patch.triangleCount; ++t) {
            mesh::Triangle& corners = out_.triangles[t];
            Wanted wanted{noIndex, materialIndex(provenance_, out_.origins[t]), 0};
            if (!charts_.empty()) wanted.chart = charts_[out_.order[t]];
            for (int corner = 0; corner < 3; ++corner) {
                if (!out_.corners.empty()) wanted.normal = out_.corners.of[out_.order[t]][corner];
                corners[corner] = vertexOf(patch, corners[corner], wanted);
            }
        }
        patch.vertexCount = static_cast<uint32_t>(out_.vertices.size()) - patch.firstVertex;
    }

private:
    struct Wanted {
        uint32_t normal, material, chart;
    };

    bool is(uint32_t v, const Wanted& wanted) const {
        return out_.charts[v] == wanted.chart && out_.materials[v] == wanted.material &&
               (out_.corners.empty() || out_.normals[v] == wanted.normal);
    }

    uint32_t vertexOf(const Patch& patch, uint32_t vertex, const Wanted& wanted) {
        // A vertex met in an earlier patch has a number below this patch's first: it is met anew.
        const uint32_t newest =
            newest_[vertex] == noIndex || newest_[vertex] < patch.firstVertex ? noIndex : newest_[vertex];
        for (uint32_t v = newest; v != noIndex; v = older_[v])
            if (is(v, wanted)) return v;
        newest_[vertex] = static_cast<uint32_t>(out_.vertices.size());
        out_.vertices.push_back(vertex);
        out_.materials.push_back(wanted.material);
        out_.charts.push_back(wanted.chart);
        older_.push_back(newest);
        if (!out_.corners.empty()) out_.normals.push_back(wanted.normal);
        return newest_[vertex];
    }

    const Provenance& provenance_;
    const std::span<const uint32_t> charts_;
    PatchedMesh& out_;
    std::vector<uint32_t> newest_;  ///< by mesh vertex: the last patch vertex made of it
    std::vector<uint32_t> older_;   ///< by patch vertex: one of the same patch and mesh vertex that differs
};

}  // namespace

const mesh::Chunk& Vertices::chunkOf(uint32_t v) {
    const auto& chunks = mesh_.chunks;
    if (v < first() || v - first() >= chunks[at_].positions.size()) {
        const auto after = std::upper_bound(chunks.begin(), chunks.end(), v,
                                            [](uint32_t value, const mesh::Chunk& c) { return value < c.firstVertex; });
        at_ = static_cast<size_t>(after - chunks.begin()) - 1;
    }
    return chunks[at_];
}

uint32_t materialIndex(const Provenance& provenance, OriginId origin) {
    const uint32_t material = provenance.parts[origin < provenance.parts.size() ? origin : 0].material;
    return material < provenance.materials.size() ? material : 0;
}

Vec3f unitNormal(Vec3f n) {
    const float l = length(n);
    return l > 0 && std::isfinite(l) ? n / l : Vec3f{0, 1, 0};
}

Rgb8 srgb(Vec3f linear) {
    Rgb8 bytes;
    for (int i = 0; i < 3; ++i) {
        const float v = std::clamp(linear[i], 0.0f, 1.0f);
        const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
        bytes[static_cast<size_t>(i)] = static_cast<uint8_t>(std::lround(255 * s));
    }
    return bytes;
}

PatchedMesh cutIntoPatches(const mesh::Mesh& mesh, const Provenance& provenance, const Cut& cut) {
    PatchedMesh out;
    out.corners = mesh::collectCornerNormals(mesh);
    sortTriangles(mesh, groupTriangles(mesh, provenance, cut), cut.byMaterial, out);
    VertexCutter cutter(mesh.vertexCount(), provenance, cut, out);
    for (Patch& patch : out.patches) cutter.cut(patch);
    return out;
}

size_t PatchedMesh::endOfObject(size_t begin) const {
    size_t end = begin;
    while (end < patches.size() && patches[end].object == patches[begin].object) ++end;
    return end;
}

Vec3f PatchedMesh::normal(uint32_t v, Vertices& ofMesh) const {
    const uint32_t own = normals.empty() ? noIndex : normals[v];
    return unitNormal(own == noIndex ? ofMesh.normal(vertices[v]) : corners.normals[own]);
}

}  // namespace sgm::exporter
