#include "modeler/mesh/pieces.h"

#include <unordered_map>

#include "modeler/mesh/components.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t unseen = 0xffffffffu;

std::vector<Vec3f> positionsOf(const Mesh& mesh) {
    std::vector<Vec3f> positions;
    positions.reserve(mesh.vertexCount());
    for (const Chunk& c : mesh.chunks) positions.insert(positions.end(), c.positions.begin(), c.positions.end());
    return positions;
}

/// Calls f(triangle, origin) for every triangle.
template <class F>
void forTriangles(const Mesh& mesh, F f) {
    for (const Chunk& c : mesh.chunks)
        for (size_t i = 0; i < c.triangles.size(); ++i) f(c.inMesh(c.triangles[i]), i < c.origins.size() ? c.origins[i] : 0);
}

using Tally = std::unordered_map<OriginId, uint64_t>;

std::vector<OriginId> byCount(const Tally& tally) {
    std::vector<OriginId> origins;
    for (const auto& entry : tally) origins.push_back(entry.first);
    std::sort(origins.begin(), origins.end(), [&](OriginId a, OriginId b) {
        const uint64_t m = tally.at(a), n = tally.at(b);
        return m != n ? m > n : a < b;
    });
    return origins;
}

void judgeSupport(std::vector<Piece>& pieces, float slack_m) {
    if (pieces.empty()) return;
    float ground = pieces[0].bounds.lo.y;
    for (const Piece& p : pieces) ground = std::min(ground, p.bounds.lo.y);
    for (Piece& p : pieces) p.floats = p.bounds.lo.y > ground + slack_m;
    std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.volume_m3 < b.volume_m3;
    })->floats = false;
}

/// Every connected surface, those around air too, and which one each vertex of the mesh is on.
struct Surfaces {
    std::vector<Piece> pieces;
    std::vector<uint32_t> of;
};

Surfaces surfacesOf(const Mesh& mesh) {
    const std::vector<Vec3f> positions = positionsOf(mesh);
    Components components(positions.size());
    forTriangles(mesh, [&](const Triangle& t, OriginId) {
        components.join(t.x, t.y);
        components.join(t.x, t.z);
    });
    Surfaces found{{}, std::vector<uint32_t>(positions.size(), unseen)};
    std::vector<Tally> tallies;
    const Vec3d near = positions.empty() ? Vec3d{} : positions.front().as<double>();
    forTriangles(mesh, [&](const Triangle& t, OriginId origin) {
        uint32_t& index = found.of[components.find(t.x)];
        if (index == unseen) {
            index = static_cast<uint32_t>(found.pieces.size());
            found.pieces.emplace_back();
            tallies.emplace_back();
        }
        Piece& piece = found.pieces[index];
        ++piece.triangles;
        ++tallies[index][origin];
        const Vec3d a = positions[t.x].as<double>() - near, b = positions[t.y].as<double>() - near,
                    c = positions[t.z].as<double>() - near;
        piece.volume_m3 += dot(a, cross(b, c)) / 6;
        for (int i = 0; i < 3; ++i) piece.bounds = hull(piece.bounds, positions[t[i]]);
    });
    for (size_t i = 0; i < tallies.size(); ++i) found.pieces[i].origins = byCount(tallies[i]);
    for (uint32_t v = 0; v < found.of.size(); ++v) found.of[v] = found.of[components.find(v)];
    return found;
}

/// Drops the vertices that aren't marked, with their triangles; the borders between chunks follow.
void keepVertices(Mesh& mesh, const std::vector<bool>& stays) {
    std::vector<uint32_t> now(stays.size(), unseen);  // numbers in the mesh
    uint32_t next = 0;
    for (size_t v = 0; v < stays.size(); ++v)
        if (stays[v]) now[v] = next++;
    std::vector<uint32_t> borrowedNow;  // places in a chunk's list
    for (Chunk& c : mesh.chunks) {
        const uint32_t first = c.firstVertex, own = static_cast<uint32_t>(c.positions.size());
        uint32_t before = 0, firstNow = 0;
        for (; before < own && now[first + before] == unseen;) ++before;
        firstNow = before < own ? now[first + before] : 0;
        const auto local = [&](uint32_t v) { return now[first + v] - firstNow; };
        const auto filter = [&](SeamList& list, auto stayed, auto renamed, std::vector<uint32_t>* places) {
            uint32_t n = 0;
            for (int kind = 0; kind < seamKinds; ++kind) {
                const uint32_t from = list.begin[size_t(kind)], to = list.begin[size_t(kind) + 1];
                list.begin[size_t(kind)] = n;
                for (uint32_t i = from; i < to; ++i) {
                    if (places) places->push_back(n);
                    if (stayed(list.vertices[i])) list.vertices[n++] = renamed(list.vertices[i]);
                }
            }
            list.begin[seamKinds] = n;
            list.vertices.resize(n);
        };
        size_t kept = 0;
        for (size_t i = 0; i < c.triangles.size(); ++i)
            if (stays[c.inMesh(c.triangles[i].x)]) {
                c.triangles[kept] = c.triangles[i];
                c.origins[kept++] = c.origins[i];
            }
        c.triangles.resize(kept);
        c.origins.resize(kept);
        borrowedNow.clear();
        filter(c.borrowed, [&](uint32_t v) { return stays[v]; }, [&](uint32_t v) { return now[v]; }, &borrowedNow);
        filter(c.lent, [&](uint32_t v) { return stays[first + v]; }, local, nullptr);
        for (Triangle& t : c.triangles)
            for (int i = 0; i < 3; ++i)
                t[i] = t[i] & borrowedBit ? borrowedNow[t[i] & ~borrowedBit] | borrowedBit : local(t[i]);
        std::erase_if(c.faceted, [&](uint32_t v) { return !stays[first + v]; });
        for (uint32_t& v : c.faceted) v = local(v);
        uint32_t n = 0;
        for (uint32_t v = 0; v < own; ++v)
            if (stays[first + v]) {
                c.positions[n] = c.positions[v];
                c.normals[n++] = c.normals[v];
            }
        c.positions.resize(n);
        c.normals.resize(n);
    }
    uint32_t firstVertex = 0;
    for (Chunk& c : mesh.chunks) {
        c.firstVertex = firstVertex;
        firstVertex += static_cast<uint32_t>(c.positions.size());
    }
    std::erase_if(mesh.chunks, [](const Chunk& c) { return c.positions.empty() && c.triangles.empty(); });
}

}  // namespace

std::vector<Piece> pieces(const Mesh& mesh, float slack_m) {
    std::vector<Piece> found = surfacesOf(mesh).pieces;
    std::erase_if(found, [](const Piece& p) { return p.volume_m3 <= 0; });
    judgeSupport(found, slack_m);
    return found;
}

std::vector<bool> staying(std::vector<Piece> solids, Keep keep, float slack_m) {
    std::vector<bool> stays(solids.size(), keep == Keep::All);
    if (keep == Keep::All || solids.empty()) return stays;
    judgeSupport(solids, slack_m);
    const auto less = [](const Piece& a, const Piece& b) { return a.volume_m3 < b.volume_m3; };
    const auto greatest = std::max_element(solids.begin(), solids.end(), less);
    for (size_t i = 0; i < solids.size(); ++i)
        stays[i] = keep == Keep::Grounded && !solids[i].floats && solids[i].volume_m3 >= 1e-3 * greatest->volume_m3;
    stays[static_cast<size_t>(greatest - solids.begin())] = true;
    return stays;
}

Dropped keepOnly(Mesh& mesh, Keep keep, float slack_m) {
    Dropped dropped;
    if (keep == Keep::All || mesh.triangleCount() == 0) return dropped;
    const Surfaces surfaces = surfacesOf(mesh);
    std::vector<Piece> solids;
    std::vector<size_t> solidOf(surfaces.pieces.size(), surfaces.pieces.size());
    for (size_t i = 0; i < surfaces.pieces.size(); ++i)
        if (surfaces.pieces[i].volume_m3 > 0) {
            solidOf[i] = solids.size();
            solids.push_back(surfaces.pieces[i]);
        }
    const std::vector<bool> solidStays = staying(solids, keep, slack_m);
    std::vector<bool> pieceStays(surfaces.pieces.size(), false);
    for (size_t i = 0; i < surfaces.pieces.size(); ++i) {
        if (solidOf[i] == surfaces.pieces.size()) {
            ++dropped.cavities;
            dropped.filled_m3 -= surfaces.pieces[i].volume_m3;
        } else if (solidStays[solidOf[i]]) {
            pieceStays[i] = true;
        } else {
            ++dropped.pieces;
            dropped.volume_m3 += surfaces.pieces[i].volume_m3;
        }
    }
    std::vector<bool> stays(surfaces.of.size());
    for (size_t v = 0; v < stays.size(); ++v) stays[v] = surfaces.of[v] != unseen && pieceStays[surfaces.of[v]];
    keepVertices(mesh, stays);
    return dropped;
}

}  // namespace sgm::mesh
