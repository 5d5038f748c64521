#include "grammar/lower/presence.h"

#include <array>
#include <cmath>

#include "grammar/lower/mesh_positions.h"
#include "grammar/lower/scope_lines.h"
#include "modeler/core/number_set.h"
#include "modeler/core/parallel.h"
#include "modeler/mesh/point_triangle.h"

namespace sgm::lower {
namespace {

constexpr float besideLine = 5;        ///< times as far counts what lies beside a line
constexpr size_t shardsPerThread = 4;  ///< parts differ in their triangles
constexpr uint32_t noEntry = field::HashIndex::none;

Vec3i cellOf(Vec3f p, float perMetre) {
    const auto floor = [&](float c) { return static_cast<int>(std::floor(c * perMetre)); };
    return {floor(p.x), floor(p.y), floor(p.z)};
}

uint64_t keyOf(Vec3i cell, OriginId part) {
    const auto bits = [](int c) { return static_cast<uint64_t>(static_cast<uint32_t>(c)); };
    uint64_t key = part * 0xd6e8feb86659fd93u;
    for (const int c : {cell.x, cell.y, cell.z}) key = (key ^ bits(c)) * 0x9e3779b97f4a7c15u, key ^= key >> 29;
    return key;
}

size_t shardCount(int threads) {
    const auto count = static_cast<size_t>(threadCount(threads));
    return count > 1 ? shardsPerThread * count : 1;
}

/// Of the cell of twice the edge around a point; for NumberSet, not 0.
uint64_t keyAround(Vec3f p, float cell_m) { return keyOf(cellOf(p, 0.5f / cell_m), 0) | 1; }

/// The cells of twice the edge around points: the eight of each reach a cell far.
NumberSet cellsAround(std::span<const Vec3f> points, float cell_m) {
    NumberSet around;
    std::array<uint64_t, 8> last{};  // points that follow each other are often in one cell
    for (const Vec3f& p : points)
        for (size_t corner = 0; corner < last.size(); ++corner) {
            const Vec3f sign{corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f};
            const uint64_t key = keyAround(p + sign * cell_m, cell_m);
            if (key != last[corner]) around.insert(key);
            last[corner] = key;
        }
    return around;
}

}  // namespace

Presence::Presence(const mesh::Mesh& mesh, std::span<const Query> queries, std::span<const Vec3f> points, float cell_m,
                   int threads)
    : perMetre_(1 / cell_m), shards_(shardCount(threads)) {
    using Extent = Query::Extent;
    for (const Query& part : queries) reach_m_.push_back(part.reach_m);
    const NumberSet around = cellsAround(points, cell_m);
    const std::vector<const Vec3f*> positions = positionsOf(mesh);
    parallelFor(shards_.size(), threads, nullptr, [&](size_t number, int) {
        for (const mesh::Chunk& c : mesh.chunks)
            for (size_t t = 0; t < c.origins.size(); ++t) {
                const OriginId part = c.origins[t];
                if (shardOf(part) != number || queries[part].extent == Extent::Nothing) continue;
                const mesh::Triangle corners = c.inMesh(c.triangles[t]);
                const Triangle triangle{*positions[corners[0]], *positions[corners[1]], *positions[corners[2]]};
                const Vec3f middle = (triangle.a + triangle.b + triangle.c) * (1.0f / 3);
                if (queries[part].extent == Extent::All || around.contains(keyAround(middle, cell_m)))
                    addTriangle(triangle, part, shards_[number]);
            }
    });
}

void Presence::addTriangle(const Triangle& triangle, OriginId part, Shard& shard) const {
    const auto number = static_cast<uint32_t>(shard.triangles.size());
    shard.triangles.push_back(triangle);
    const float reach = reach_m_[part];
    const Vec3f lo = min(min(triangle.a, triangle.b), triangle.c) - Vec3f{reach, reach, reach},
                hi = max(max(triangle.a, triangle.b), triangle.c) + Vec3f{reach, reach, reach};
    const Vec3i first = cellOf(lo, perMetre_), last = cellOf(hi, perMetre_);
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) shard.enter(keyOf({x, y, z}, part), number);
}

void Presence::Shard::enter(uint64_t key, uint32_t triangle) {
    uint32_t cell = find(key);
    if (cell == noEntry) {
        cell = static_cast<uint32_t>(cells.size());
        cells.push_back({key, noEntry});
        index.insert(key, cell);
    }
    entries.push_back({triangle, cells[cell].newest});
    cells[cell].newest = static_cast<uint32_t>(entries.size()) - 1;
}

template <class IsNear>
bool Presence::isAny(Vec3f p, OriginId part, IsNear&& isNear) const {
    const Shard& shard = shards_[shardOf(part)];
    const uint32_t cell = shard.find(keyOf(cellOf(p, perMetre_), part));
    if (cell == noEntry) return false;
    for (uint32_t at = shard.cells[cell].newest; at != noEntry; at = shard.entries[at].next)
        if (isNear(shard.triangles[shard.entries[at].triangle])) return true;
    return false;
}

bool Presence::isNear(Vec3f p, OriginId part) const {
    const float reach = reach_m_[part];
    return isAny(p, part, [&](const Triangle& t) { return mesh::squaredDistance(p, t.a, t.b, t.c) <= reach * reach; });
}

bool Presence::isNearAlong(Vec3f p, Vec3f along, OriginId part) const {
    const float reach = reach_m_[part];
    const auto stretched = [&](Vec3f corner) {
        const Vec3f d = corner - p, on = along * dot(d, along);
        return on + (d - on) * besideLine;
    };
    return isAny(p, part, [&](const Triangle& t) {
        return mesh::squaredDistance({}, stretched(t.a), stretched(t.b), stretched(t.c)) <= reach * reach;
    });
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

}  // namespace sgm::lower
