#include "modeler/mesh/pieces.h"

#include <optional>
#include <unordered_map>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/components.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t none = SurfaceLabels::none;

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

/// Every connected surface, those around air too.
struct Surfaces {
    std::vector<Piece> pieces;  ///< without their owners
    SurfaceLabels labels;       ///< by vertex: its piece
};

/// What triangles of one label add up to.
struct Sum {
    uint64_t triangles = 0;
    double sixfold_m3 = 0;
};

Surfaces surfacesOf(const Mesh& mesh) {
    Surfaces found;
    std::vector<Sum> sums;
    const auto visit = [&](auto labelOf) {
        std::optional<Vec3d> near;  // sums stay small
        std::vector<Vec3f> borrowed;
        Sum sum;
        uint32_t last = 0;
        const auto put = [&] {
            if (sums.size() <= last) sums.resize(last + size_t{1});
            sums[last].triangles += sum.triangles, sums[last].sixfold_m3 += sum.sixfold_m3;
            sum = {};
        };
        for (const Chunk& c : mesh.chunks) {
            if (!near && !c.positions.empty()) near = c.positions.front().as<double>();
            borrowed.clear();
            for (const uint32_t v : c.borrowed.vertices) {
                const Chunk& owner = ownerOf(mesh.chunks, v);
                borrowed.push_back(owner.positions[v - owner.firstVertex]);
            }
            const auto position = [&](uint32_t corner) {
                return (corner & borrowedBit ? borrowed[corner & ~borrowedBit] : c.positions[corner]).as<double>() - *near;
            };
            for (const Triangle& t : c.triangles) {
                const uint32_t label = labelOf(c.inMesh(t));
                if (label != last) put();
                last = label;
                // The solid under a triangle along x, by the divergence theorem.
                const Vec3d p = position(t.x), q = position(t.y) - p, r = position(t.z) - p;
                sum.sixfold_m3 += (3 * p.x + q.x + r.x) * (q.y * r.z - q.z * r.y);
                ++sum.triangles;
            }
        }
        put();
    };
    found.labels = labelSurfaces(mesh.vertexCount(), visit);
    found.pieces.resize(found.labels.count);
    for (size_t label = 0; label < found.labels.numbers.size(); ++label) {
        Piece& piece = found.pieces[found.labels.numbers[label]];
        piece.triangles += sums[label].triangles;
        piece.volume_m3 += sums[label].sixfold_m3 / 6;
    }
    for (const Chunk& c : mesh.chunks) {
        const uint32_t* const own = found.labels.of.data() + c.firstVertex;
        const auto count = static_cast<uint32_t>(c.positions.size());
        for (uint32_t v = 0, piece; v < count;) {  // neighbours lie on one piece mostly
            Box3f box;
            for (piece = own[v]; v < count && own[v] == piece; ++v) box = hull(box, c.positions[v]);
            if (piece != none) found.pieces[piece].bounds = hull(found.pieces[piece].bounds, box);
        }
    }
    return found;
}

/// Who owns each surface, most triangles first.
void findOwners(const Mesh& mesh, Surfaces& surfaces) {
    std::vector<Tally> tallies(surfaces.pieces.size());
    forTriangles(mesh, [&](const Triangle& t, OriginId origin) { ++tallies[surfaces.labels.of[t.x]][origin]; });
    for (size_t i = 0; i < tallies.size(); ++i) surfaces.pieces[i].origins = byCount(tallies[i]);
}

/// Drops the surfaces that don't stay, with vertices that have no triangle; the borders between chunks follow.
void keepSurfaces(Mesh& mesh, const Surfaces& surfaces, const std::vector<bool>& pieceStays) {
    std::vector<uint32_t> now(surfaces.labels.of.size(), none);  // numbers in the mesh
    uint32_t next = 0;
    for (size_t v = 0; v < now.size(); ++v)
        if (surfaces.labels.of[v] != none && pieceStays[surfaces.labels.of[v]]) now[v] = next++;
    const auto stays = [&](uint32_t v) { return now[v] != none; };
    std::vector<uint32_t> borrowedNow;  // places in a chunk's list
    uint32_t firstVertex = 0;
    for (Chunk& c : mesh.chunks) {
        const uint32_t first = c.firstVertex, own = static_cast<uint32_t>(c.positions.size());
        const uint32_t staying = static_cast<uint32_t>(std::count_if(now.begin() + first, now.begin() + first + own, [](uint32_t v) { return v != none; }));
        const auto local = [&](uint32_t v) { return now[first + v] - firstVertex; };
        if (staying == own && std::all_of(c.borrowed.vertices.begin(), c.borrowed.vertices.end(), stays)) {
            for (uint32_t& v : c.borrowed.vertices) v = now[v];
        } else {
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
            const bool bare = c.isBare();
            size_t kept = 0;
            for (size_t i = 0; i < c.triangles.size(); ++i)
                if (stays(c.inMesh(c.triangles[i].x))) {
                    if (!bare) c.origins[kept] = c.origins[i];
                    c.triangles[kept++] = c.triangles[i];
                }
            c.triangles.resize(kept);
            if (!bare) c.origins.resize(kept);
            borrowedNow.clear();
            filter(c.borrowed, stays, [&](uint32_t v) { return now[v]; }, &borrowedNow);
            filter(c.lent, [&](uint32_t v) { return stays(first + v); }, local, nullptr);
            for (Triangle& t : c.triangles)
                for (int i = 0; i < 3; ++i) t[i] = t[i] & borrowedBit ? borrowedNow[t[i] & ~borrowedBit] | borrowedBit : local(t[i]);
            std::erase_if(c.faceted, [&](uint32_t v) { return !stays(first + v); });
            for (uint32_t& v : c.faceted) v = local(v);
            uint32_t n = 0;
            for (uint32_t v = 0; v < own; ++v)
                if (stays(first + v)) {
                    if (!bare) c.normals[n] = c.normals[v];
                    c.positions[n++] = c.positions[v];
                }
            c.positions.resize(n);
            if (!bare) c.normals.resize(n);
        }
        c.firstVertex = firstVertex;
        firstVertex += staying;
    }
    std::erase_if(mesh.chunks, [](const Chunk& c) { return c.positions.empty() && c.triangles.empty(); });
}

}  // namespace

std::vector<Piece> pieces(const Mesh& mesh, float slack_m) {
    Surfaces surfaces = surfacesOf(mesh);
    findOwners(mesh, surfaces);
    std::vector<Piece> found = std::move(surfaces.pieces);
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
    if (dropped.pieces + dropped.cavities > 0) keepSurfaces(mesh, surfaces, pieceStays);
    return dropped;
}

}  // namespace sgm::mesh
