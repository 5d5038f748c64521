#include "modeler/mesh/wide_vertices.h"

#include <algorithm>
#include <array>

namespace sgm::mesh {
namespace {

constexpr uint32_t none = 0xffffffffu;
/// The mean of the normals around a tip is shorter; along edges of 90° it is .7 or more.
constexpr float widestSmooth = 0.85f, widestCreased = 0.7f;
/// Cosine between the normals of an even triangle's corners, at least. Where all triangles around a vertex are even,
/// the mean of their normals is at least (1 + 2 · .8) / 3 long, and the vertex isn't wide.
constexpr float leastEven = 0.8f;

/// Of all normals at the triangles around a vertex.
struct Sum {
    Vec3f normals;
    float count = 0;
    bool isCreased = false;

    void add(Vec3f ofTriangle, bool hasOwnNormals) {
        normals += ofTriangle, count += 3;
        isCreased |= hasOwnNormals;
    }
    bool isWide() const {
        const float most = (isCreased ? widestCreased : widestSmooth) * count;
        return dot(normals, normals) < most * most;
    }
};

/// Most vertices of a building lie amid even triangles, so that only the others' normals are added up.
class WideVertexFinder {
public:
    WideVertexFinder(const TipMesh& mesh, const Progress* progress)
        : mesh_(mesh), progress_(progress), isUneven_(mesh.positions().size()), beside_(mesh.chunkCount()) {}

    std::vector<WideVertex> find() {
        markUneven();
        addNormals();
        std::vector<WideVertex> wide;
        if (cancelled(progress_)) return wide;
        place_.assign(isUneven_.size(), none);
        for (uint32_t v = 0; v < isUneven_.size(); ++v) {
            if (!isUneven_[v] || (!sums_[v].isWide() && !(mesh_.isConfined()[v] && sums_[v].isCreased))) continue;
            place_[v] = static_cast<uint32_t>(wide.size());
            wide.push_back({v, {}, {}, 0, noLabel});
        }
        if (wide.empty()) return wide;
        addTriangles(wide);
        std::erase_if(wide, [&](const WideVertex& at) { return !sums_[at.vertex].isWide() && !at.isCorner; });
        return wide;
    }

private:
    using Normals = std::array<Vec3f, 3>;

    Normals normalsOf(const Chunk& chunk, const Triangle& corners) const {
        const auto& normals = mesh_.normals();
        return {normals[chunk.inMesh(corners.x)], normals[chunk.inMesh(corners.y)], normals[chunk.inMesh(corners.z)]};
    }

    static bool isEven(const Normals& n) {
        if (n[0] == n[1] && n[1] == n[2]) return n[0] != Vec3f{};
        return dot(n[0], n[1]) > leastEven && dot(n[1], n[2]) > leastEven && dot(n[2], n[0]) > leastEven;
    }

    /// Marks the vertices of triangles that aren't even.
    void markUneven() {
        std::vector<std::vector<uint32_t>> borrowed(mesh_.chunkCount());  // vertices that other chunks own
        mesh_.inChunks([&](size_t c) {
            const Chunk& chunk = mesh_.chunk(c);
            visitTriangles(chunk, [&](uint32_t t, std::span<const CornerNormal> own) {
                const Triangle& corners = chunk.triangles[t];
                if (own.empty() && isEven(normalsOf(chunk, corners))) return;
                for (int k = 0; k < 3; ++k) {
                    if (corners[k] & ghostBit)
                        borrowed[c].push_back(chunk.inMesh(corners[k]));
                    else
                        isUneven_[chunk.inMesh(corners[k])] = 1;
                }
            });
        });
        for (const auto& list : borrowed)
            for (const uint32_t v : list) isUneven_[v] = 1;
    }

    /// Adds up the normals around marked vertices, and lists the triangles beside them.
    void addNormals() {
        sums_.resize(isUneven_.size());
        for (size_t v = 0; v < isUneven_.size(); ++v)
            if (isUneven_[v]) sums_[v] = {};
        struct Addend {
            uint32_t vertex;
            Vec3f ofTriangle;
            bool hasOwnNormals;
        };
        std::vector<std::vector<Addend>> borrowed(mesh_.chunkCount());
        mesh_.inChunks([&](size_t c) {
            const Chunk& chunk = mesh_.chunk(c);
            visitTriangles(chunk, [&](uint32_t t, std::span<const CornerNormal> own) {
                const Triangle &corners = chunk.triangles[t], inMesh = chunk.inMesh(corners);
                if (!isUneven_[inMesh.x] && !isUneven_[inMesh.y] && !isUneven_[inMesh.z]) return;
                beside_[c].push_back(t);
                Normals normals = normalsOf(chunk, corners);
                for (const CornerNormal& n : own) normals[n.corner % 3] = n.normal;
                const Vec3f sum = normals[0] + normals[1] + normals[2];
                for (int k = 0; k < 3; ++k) {
                    if (!isUneven_[inMesh[k]]) continue;
                    if (corners[k] & ghostBit)
                        borrowed[c].push_back({inMesh[k], sum, !own.empty()});
                    else
                        sums_[inMesh[k]].add(sum, !own.empty());
                }
            });
        });
        for (const auto& list : borrowed)  // in the chunks' order
            for (const Addend& a : list) sums_[a.vertex].add(a.ofTriangle, a.hasOwnNormals);
    }

    /// What the triangles around some vertices say of them.
    void addTriangles(std::vector<WideVertex>& wide) const {
        const auto listWide = [&](size_t c, std::vector<uint32_t>& numbers) {
            const Chunk& chunk = mesh_.chunk(c);
            for (const uint32_t t : beside_[c]) {
                const Triangle corners = chunk.inMesh(chunk.triangles[t]);
                if (std::min({place_[corners.x], place_[corners.y], place_[corners.z]}) != none) numbers.push_back(t);
            }
        };
        for (const TipTriangle& t : mesh_.trianglesOf(listWide))
            for (int k = 0; k < 3; ++k) {
                if (place_[t.corners[k]] == none) continue;
                WideVertex& at = wide[place_[t.corners[k]]];
                if (at.label == noLabel) at.label = t.label;
                if (at.label != t.label) {
                    at.isCorner |= at.second != noLabel && at.second != t.label;
                    if (at.second == noLabel) at.second = t.label;
                    at.hasCreases = true;
                }
                at.origin = t.origin;
                for (size_t i = 0; i < 3; ++i) {
                    at.directions.add(t.normals[i].as<double>(), {});
                    if (static_cast<int>(i) != k) at.addPlane(mesh_, t, i);
                }
            }
    }

    const TipMesh& mesh_;
    const Progress* const progress_;
    std::vector<uint8_t> isUneven_;              ///< by vertex
    PageVector<Sum> sums_;                       ///< by vertex, of uneven ones
    std::vector<std::vector<uint32_t>> beside_;  ///< by chunk: its triangles beside uneven vertices
    std::vector<uint32_t> place_;                ///< by vertex: among the wide ones
};

}  // namespace

void WideVertex::addPlane(const TipMesh& mesh, const TipTriangle& triangle, size_t corner) {
    const uint32_t v = triangle.corners[static_cast<int>(corner)];
    if (mesh.isConfined()[v]) return;
    planes.add(triangle.normals[corner].as<double>(), (mesh.positions()[v] - mesh.positions()[vertex]).as<double>());
}

std::vector<WideVertex> findWideVertices(const TipMesh& mesh, const Progress* progress) {
    return WideVertexFinder(mesh, progress).find();
}

}  // namespace sgm::mesh
