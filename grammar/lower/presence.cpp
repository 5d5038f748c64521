#include "grammar/lower/presence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "grammar/lower/mesh_positions.h"
#include "grammar/lower/scope_lines.h"

namespace sgm::lower {
namespace {

constexpr int fewestParts = 4, mostParts = 64;  ///< of a side of a triangle that is sampled

}  // namespace

Presence::Presence(const mesh::Mesh& mesh, std::span<const Query> queries, std::span<const Vec3f> points,
                   float cell_m) {
    using Extent = Query::Extent;
    for (const Query& part : queries) perMetre_.push_back(part.extent == Extent::Nothing ? 0 : 1 / part.reach_m);
    constexpr OriginId any = 0;
    const float perMetre = 0.5f / cell_m;  // of cells of twice the edge: the eight around a point reach a cell far
    const auto keyAt = [&](Vec3f p) { return keyOf(cellOf(p, perMetre), any); };
    NumberSet around;
    std::array<uint64_t, 8> last{};  // points that follow each other are often in one cell
    for (const Vec3f& p : points)
        for (size_t corner = 0; corner < last.size(); ++corner) {
            const Vec3f sign{corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f};
            const uint64_t key = keyAt(p + sign * cell_m);
            if (key != last[corner]) around.insert(key);
            last[corner] = key;
        }
    const std::vector<const Vec3f*> positions = positionsOf(mesh);
    for (const mesh::Chunk& c : mesh.chunks)
        for (size_t t = 0; t < c.origins.size(); ++t) {
            const Extent extent = queries[c.origins[t]].extent;
            if (extent == Extent::Nothing) continue;
            const mesh::Triangle corners = c.inMesh(c.triangles[t]);
            const Vec3f p = *positions[corners[0]], q = *positions[corners[1]], r = *positions[corners[2]];
            if (extent == Extent::All || around.contains(keyAt((p + q + r) * (1.0f / 3))))
                addTriangle(p, q, r, c.origins[t]);
        }
}

void Presence::addTriangle(Vec3f p, Vec3f q, Vec3f r, OriginId part) {
    const float longest = std::sqrt(std::max({dot(q - p, q - p), dot(r - q, r - q), dot(p - r, p - r)}));
    const int parts = std::clamp(static_cast<int>(std::ceil(longest * perMetre_[part])), fewestParts, mostParts);
    for (int u = 0; u <= parts; ++u)
        for (int v = 0; u + v <= parts; ++v) {
            const Vec3f at = p + (q - p) * (static_cast<float>(u) / static_cast<float>(parts)) +
                             (r - p) * (static_cast<float>(v) / static_cast<float>(parts));
            const uint64_t key = keyOf(cellOf(at, part), part);
            if (key != last_) cells_.insert(key);
            last_ = key;
        }
}

bool Presence::isNear(Vec3f p, OriginId part) const {
    const Vec3i cell = cellOf(p, part);
    if (cells_.contains(keyOf(cell, part))) return true;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (cells_.contains(keyOf(cell + Vec3i{x, y, z}, part))) return true;
    return false;
}

bool Presence::isWhole(const derive::Scope& scope, OriginId part, double cell_m) const {
    return eachLine(scope, cell_m, [&](Vec3d share, int axis) {
        for (const double end : {0., -lineReach, lineReach}) {
            share[axis] = end;
            if (!isNear(scope.point(share).as<float>(), part)) return false;
        }
        return true;
    });
}

Vec3i Presence::cellOf(Vec3f p, float perMetre) {
    const auto floor = [&](float c) { return static_cast<int>(std::floor(c * perMetre)); };
    return {floor(p.x), floor(p.y), floor(p.z)};
}

uint64_t Presence::keyOf(Vec3i cell, OriginId part) {
    const auto bits = [](int c) { return static_cast<uint64_t>(static_cast<uint32_t>(c)); };
    uint64_t key = part * 0xd6e8feb86659fd93u;
    for (const int c : {cell.x, cell.y, cell.z}) key = (key ^ bits(c)) * 0x9e3779b97f4a7c15u, key ^= key >> 29;
    return key | 1;
}

}  // namespace sgm::lower
