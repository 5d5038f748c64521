#include "modeler/export/surface.h"

#include <algorithm>
#include <cmath>

namespace sgm::exporter {
namespace {

constexpr uint32_t facings = 6;
using mesh::noIndex;

/// The group (material · 6 + facing) of every triangle, in mesh order.
std::vector<uint32_t> groupTriangles(const mesh::Mesh& mesh, const Provenance& provenance, bool cutByFacing) {
    Vertices vertices(mesh);
    std::vector<uint32_t> groups;
    groups.reserve(mesh.triangleCount());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (size_t i = 0; i < chunk.triangles.size(); ++i) {
            const mesh::Triangle t = chunk.inMesh(chunk.triangles[i]);
            uint32_t group = materialIndex(provenance, chunk.origins[i]) * facings;
            if (cutByFacing) {
                const Vec3f a = vertices.position(t.x), b = vertices.position(t.y), c = vertices.position(t.z);
                group += static_cast<uint32_t>(facing(cross(b - a, c - a)));
            }
            groups.push_back(group);
        }
    return groups;
}

/// Counting sort of the mesh's triangles by group; fills the patches' triangle ranges.
void sortTriangles(const mesh::Mesh& mesh, const std::vector<uint32_t>& groups, PatchedMesh& out) {
    const uint32_t groupCount = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
    std::vector<uint32_t> next(groupCount + 1, 0);
    for (const uint32_t g : groups) ++next[g + 1];
    for (uint32_t g = 0; g < groupCount; ++g) {
        if (next[g + 1] > 0) {
            Patch patch;
            patch.material = g / facings;
            patch.facing = static_cast<int>(g % facings);
            patch.firstTriangle = next[g];
            patch.triangleCount = next[g + 1];
            out.patches.push_back(patch);
        }
        next[g + 1] += next[g];
    }
    out.triangles.resize(groups.size());
    out.order.resize(groups.size());
    uint32_t i = 0;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const mesh::Triangle& t : chunk.triangles) {
            const uint32_t at = next[groups[i]]++;
            out.triangles[at] = chunk.inMesh(t);
            out.order[at] = i++;
        }
}

/// Numbers the vertices of patches, one for each mesh vertex and normal in a patch, in the order of their first
/// corners.
class VertexCutter {
public:
    VertexCutter(PatchedMesh& out, size_t meshVertices) : out_(out), newest_(meshVertices, noIndex) {
        out_.vertices.reserve(meshVertices);
    }
    void cut(Patch& patch) {
        patch.firstVertex = static_cast<uint32_t>(out_.vertices.size());
        for (uint32_t t = patch.firstTriangle; t < patch.firstTriangle + patch.triangleCount; ++t)
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t normal = out_.corners.empty() ? noIndex : out_.corners.of[out_.order[t]][corner];
                uint32_t& index = out_.triangles[t][corner];
                index = vertexOf(patch, index, normal);
            }
        patch.vertexCount = static_cast<uint32_t>(out_.vertices.size()) - patch.firstVertex;
    }

private:
    uint32_t vertexOf(const Patch& patch, uint32_t vertex, uint32_t normal) {
        // A vertex met in an earlier patch has a number below this patch's first: it is met anew.
        const uint32_t newest =
            newest_[vertex] == noIndex || newest_[vertex] < patch.firstVertex ? noIndex : newest_[vertex];
        for (uint32_t v = newest; v != noIndex; v = out_.corners.empty() ? noIndex : older_[v])
            if (out_.corners.empty() || out_.normals[v] == normal) return v;
        newest_[vertex] = static_cast<uint32_t>(out_.vertices.size());
        out_.vertices.push_back(vertex);
        if (!out_.corners.empty()) {
            out_.normals.push_back(normal);
            older_.push_back(newest);
        }
        return newest_[vertex];
    }

    PatchedMesh& out_;
    std::vector<uint32_t> newest_;  ///< by mesh vertex: the last patch vertex made of it
    std::vector<uint32_t> older_;   ///< by patch vertex: one of the same patch and mesh vertex with another normal
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

int facing(Vec3f d) {
    const Vec3f a{std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

std::array<float, 2> boxProjection(Vec3f p, int facing) {
    switch (facing) {
        case 0:
            return {-p.z, p.y};
        case 1:
            return {p.z, p.y};
        case 2:
            return {p.x, -p.z};
        case 3:
            return {p.x, p.z};
        case 4:
            return {p.x, p.y};
        default:
            return {-p.x, p.y};
    }
}

PatchedMesh cutIntoPatches(const mesh::Mesh& mesh, const Provenance& provenance, bool cutByFacing) {
    PatchedMesh out;
    out.corners = mesh::collectCornerNormals(mesh);
    sortTriangles(mesh, groupTriangles(mesh, provenance, cutByFacing), out);
    VertexCutter cutter(out, mesh.vertexCount());
    for (Patch& patch : out.patches) cutter.cut(patch);
    return out;
}

Vec3f PatchedMesh::normal(uint32_t v, Vertices& ofMesh) const {
    const uint32_t own = normals.empty() ? noIndex : normals[v];
    return unitNormal(own == noIndex ? ofMesh.normal(vertices[v]) : corners.normals[own]);
}

}  // namespace sgm::exporter
