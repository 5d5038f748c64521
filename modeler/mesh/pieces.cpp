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

}  // namespace

std::vector<Piece> pieces(const Mesh& mesh, float slack_m) {
    const std::vector<Vec3f> positions = positionsOf(mesh);
    Components components(positions.size());
    forTriangles(mesh, [&](const Triangle& t, OriginId) {
        components.join(t.x, t.y);
        components.join(t.x, t.z);
    });
    std::vector<Piece> found;
    std::vector<Tally> tallies;
    std::vector<uint32_t> pieceOf(positions.size(), unseen);
    const Vec3d near = positions.empty() ? Vec3d{} : positions.front().as<double>();
    forTriangles(mesh, [&](const Triangle& t, OriginId origin) {
        uint32_t& index = pieceOf[components.find(t.x)];
        if (index == unseen) {
            index = static_cast<uint32_t>(found.size());
            found.emplace_back();
            tallies.emplace_back();
        }
        Piece& piece = found[index];
        ++piece.triangles;
        ++tallies[index][origin];
        const Vec3d a = positions[t.x].as<double>() - near, b = positions[t.y].as<double>() - near,
                    c = positions[t.z].as<double>() - near;
        piece.volume_m3 += dot(a, cross(b, c)) / 6;
        for (int i = 0; i < 3; ++i) piece.bounds = hull(piece.bounds, positions[t[i]]);
    });
    for (size_t i = 0; i < found.size(); ++i) found[i].origins = byCount(tallies[i]);
    std::erase_if(found, [](const Piece& p) { return p.volume_m3 <= 0; });
    judgeSupport(found, slack_m);
    return found;
}

}  // namespace sgm::mesh
