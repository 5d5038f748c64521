#include "modeler/mesh/corners.h"

#include <unordered_map>

#include "modeler/core/vec_hash.h"
#include "modeler/mesh/components.h"

namespace sgm::mesh {
namespace {

/// Numbers the normals of corners whose vertices have several, and says when two are the same to the eye.
class NormalNumbers {
public:
    NormalNumbers(const Mesh& mesh, std::span<const Triangle> triangles, const CornerNormalTable& corners)
        : triangles_(triangles), corners_(corners) {
        normals_.reserve(mesh.vertexCount());
        for (const Chunk& c : mesh.chunks) normals_.insert(normals_.end(), c.normals.begin(), c.normals.end());
    }
    /// Whether corner j of triangle t and corner k of triangle u, which are one vertex, are shaded alike.
    bool agree(size_t t, int j, size_t u, int k) const {
        const uint32_t a = corners_.of[t][j], b = corners_.of[u][k];
        return a == b || dot(normal(t, j), normal(u, k)) > 1 - 1e-5f;  // a quarter of a degree
    }

private:
    Vec3f normal(size_t t, int k) const {
        const uint32_t own = corners_.of[t][k];
        return normalized(own == noIndex ? normals_[triangles_[t][k]] : corners_.normals[own]);
    }

    std::span<const Triangle> triangles_;
    const CornerNormalTable& corners_;
    std::vector<Vec3f> normals_;  ///< by vertex
};

/// The smooth pieces: triangles joined across edges at both ends of which the normals agree. By triangle, the lowest
/// triangle of its piece.
std::vector<uint32_t> findSmoothPieces(const NormalNumbers& normals, std::span<const Triangle> triangles,
                                       std::span<const Triangle> neighbours) {
    Components joined(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t u = neighbours[t][k];
            if (u == noIndex || u < t) continue;
            const uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            int ofA = 0, ofB = 0;
            for (int j = 0; j < 3; ++j) {
                if (triangles[u][j] == a) ofA = j;
                if (triangles[u][j] == b) ofB = j;
            }
            if (normals.agree(t, k, u, ofA) && normals.agree(t, (k + 1) % 3, u, ofB))
                joined.join(static_cast<uint32_t>(t), u);
        }
    std::vector<uint32_t> pieces(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) pieces[t] = joined.find(static_cast<uint32_t>(t));
    return pieces;
}

/// Pairs (vertex, piece) without repetition, ascending.
std::vector<std::pair<uint32_t, uint32_t>> piecesAtVertices(std::span<const Triangle> triangles,
                                                            const std::vector<uint32_t>& pieces) {
    std::vector<std::pair<uint32_t, uint32_t>> at;
    at.reserve(3 * triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) at.emplace_back(triangles[t][k], pieces[t]);
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    return at;
}

/// Pairs of pieces that share a vertex, both ways, ascending.
std::vector<std::pair<uint32_t, uint32_t>> meetingPieces(const std::vector<std::pair<uint32_t, uint32_t>>& at) {
    std::vector<std::pair<uint32_t, uint32_t>> meets;
    for (size_t begin = 0; begin < at.size();) {
        size_t end = begin;
        while (end < at.size() && at[end].first == at[begin].first) ++end;
        for (size_t i = begin; i < end; ++i)
            for (size_t j = begin; j < end; ++j)
                if (i != j) meets.emplace_back(at[i].second, at[j].second);
        begin = end;
    }
    std::sort(meets.begin(), meets.end());
    meets.erase(std::unique(meets.begin(), meets.end()), meets.end());
    return meets;
}

}  // namespace

CornerNormalTable collectCornerNormals(const Mesh& mesh) {
    CornerNormalTable table;
    if (std::all_of(mesh.chunks.begin(), mesh.chunks.end(), [](const Chunk& c) { return c.cornerNormals.empty(); }))
        return table;
    table.of.assign(mesh.triangleCount(), {noIndex, noIndex, noIndex});
    std::unordered_map<Vec3f, uint32_t, Vec3fHash> known;
    size_t first = 0;
    for (const Chunk& c : mesh.chunks) {
        for (const CornerNormal& own : c.cornerNormals) {
            const auto [at, fresh] = known.try_emplace(own.normal, static_cast<uint32_t>(table.normals.size()));
            if (fresh) table.normals.push_back(own.normal);
            table.of[first + own.corner / 3][static_cast<int>(own.corner % 3)] = at->second;
        }
        first += c.triangles.size();
    }
    return table;
}

std::vector<Triangle> gatherTriangles(const Mesh& mesh) {
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangleCount());
    for (const Chunk& c : mesh.chunks)
        for (const Triangle& t : c.triangles) triangles.push_back(c.inMesh(t));
    return triangles;
}

std::vector<Triangle> findEdgeNeighbours(std::span<const Triangle> triangles, size_t vertexCount) {
    struct HalfEdge {
        uint32_t to, triangle;
    };
    std::vector<uint32_t> begin(vertexCount + 2, 0);  // of the half-edges from a vertex; filled one place late
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k) ++begin[t[k] + 2];
    for (size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<HalfEdge> edges(3 * triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            edges[begin[triangles[t][k] + 1]++] = {triangles[t][(k + 1) % 3], static_cast<uint32_t>(t)};
    std::vector<Triangle> neighbours(triangles.size(), {noIndex, noIndex, noIndex});
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
            for (uint32_t i = begin[to]; i < begin[to + 1]; ++i) {
                if (edges[i].to != from || edges[i].triangle == t) continue;
                neighbours[t][k] = edges[i].triangle;
                break;
            }
        }
    return neighbours;
}

std::vector<uint32_t> findSmoothingGroups(const Mesh& mesh, std::span<const Triangle> triangles,
                                          const CornerNormalTable& corners, std::span<const Triangle> neighbours) {
    if (corners.empty()) return std::vector<uint32_t>(triangles.size(), 1);
    const std::vector<uint32_t> pieces =
        findSmoothPieces(NormalNumbers(mesh, triangles, corners), triangles, neighbours);
    const auto meets = meetingPieces(piecesAtVertices(triangles, pieces));
    std::vector<uint32_t> groups(triangles.size(), 0);  // of a piece at its lowest triangle, then of all
    std::vector<uint32_t> taken;                        // by group: the piece that it was last taken for, plus one
    size_t i = 0;
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        if (pieces[t] != t) {
            groups[t] = groups[pieces[t]];
            continue;
        }
        while (i < meets.size() && meets[i].first < t) ++i;
        for (; i < meets.size() && meets[i].first == t; ++i) {
            const uint32_t group = groups[meets[i].second];
            if (group >= taken.size()) taken.resize(group + 1, 0);
            taken[group] = t + 1;
        }
        uint32_t group = 1;
        while (group < taken.size() && taken[group] == t + 1) ++group;
        groups[t] = group;
    }
    return groups;
}

}  // namespace sgm::mesh
