#include "modeler/volume/cave.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "modeler/volume/cave_parts.h"

namespace sgm::volume {
namespace {

bool before(const FloorCell& a, const FloorCell& b) { return std::tie(a.x, a.z) < std::tie(b.x, b.z); }

/// True when the agent can stand on the floor at p.
bool standsAt(const Cave& cave, Vec3f p) {
    const Vec3f index = (p - cave.origin) / cave.voxel_m;
    const FloorCell wanted{static_cast<int32_t>(std::lround(index.x)), static_cast<int32_t>(std::lround(index.z)), 0};
    const auto [first, last] = std::equal_range(cave.walkable.begin(), cave.walkable.end(), wanted, before);
    return std::any_of(first, last, [&](const FloorCell& f) { return std::abs(f.y_m - p.y) <= 2 * cave.voxel_m; });
}

/// Takes away the floor that the filter refuses.
void dropFloor(Air& air, const FloorFilter& isFloor) {
    std::vector<Vec3f> places;
    std::vector<size_t> of;
    for (uint32_t i = 0; i < air.size(); ++i) {
        if (std::isnan(air.floor_m[i])) continue;
        Vec3f place = air.place(i);
        place.y = air.floor_m[i];
        places.push_back(place);
        of.push_back(i);
    }
    const std::vector<bool> kept = isFloor(places);
    for (size_t k = 0; k < of.size(); ++k)
        if (!kept[k]) air.floor_m[of[k]] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

float Cave::narrowest_m() const {
    float least = std::numeric_limits<float>::infinity();
    for (const Passage& p : passages)
        if (rooms[p.rooms[0]].space == 0) least = std::min(least, p.radius_m);
    for (const Entrance& e : entrances)
        if (e.space == 0) least = std::min(least, e.bottleneck_m);
    return least;
}

Result<Cave> surveyCave(const Volume& level, const Agent& agent, bool hollow, Progress* progress,
                        const FloorFilter& isFloor) {
    if (!(agent.radius_m > 0))
        return Error{Error::Kind::Usage,
                     fmt::format("an agent of radius {} m: it takes a radius above 0", agent.radius_m)};
    if (!(agent.height_m >= 2 * agent.radius_m) || !(agent.height_m < 1e6))
        return Error{Error::Kind::Usage,
                     fmt::format("an agent of radius {} m and height {} m: the height is at least twice the radius",
                                 agent.radius_m, agent.height_m)};
    if (!(agent.slope_rad > 0) || !(agent.slope_rad <= radians(80.0)))
        return Error{Error::Kind::Usage,
                     fmt::format("an agent's steepest floor of {} degrees: it takes more than 0, at most 80",
                                 degrees(agent.slope_rad))};
    Result<Air> air = airOf(level, hollow, progress);
    if (!air.ok()) return air.error();
    if (isFloor) dropFloor(*air, isFloor);
    Cave cave;
    cave.agent = agent;
    cave.origin = air->origin;
    cave.voxel_m = air->voxel_m;
    cave.air_m3 = static_cast<double>(air->size()) * std::pow(static_cast<double>(air->voxel_m), 3);
    const std::vector<uint32_t> spaceOf = findRooms(*air, cave);
    if (cancelled(progress)) return cancelledError();
    findWays(*air, spaceOf, cave);
    return cave;
}

mesh::Mesh walkableFloor(const mesh::Mesh& mesh, const Cave& cave) {
    const float upright = static_cast<float>(std::cos(cave.agent.slope_rad)) - 0.05f;
    const bool positionsOnly = mesh.hasPositionsOnly();
    std::vector<const Vec3f*> position(mesh.vertexCount()), normal(positionsOnly ? 0 : mesh.vertexCount());
    for (const mesh::Chunk& c : mesh.chunks)
        for (size_t i = 0; i < c.positions.size(); ++i) {
            position[c.firstVertex + i] = &c.positions[i];
            if (!positionsOnly) normal[c.firstVertex + i] = &c.normals[i];
        }
    mesh::Chunk kept;
    std::vector<uint32_t> numberOf(mesh.vertexCount(), nowhere);
    for (const mesh::Chunk& c : mesh.chunks) {
        auto hard = c.cornerNormals.begin();
        for (size_t t = 0; t < c.triangles.size(); ++t) {
            const mesh::Triangle tri = c.inMesh(c.triangles[t]);
            const Vec3f a = *position[tri.x], b = *position[tri.y], d = *position[tri.z];
            const Vec3f n = normalized(cross(b - a, d - a));
            if (n.y < upright || !standsAt(cave, (a + b + d) / 3.0f)) continue;
            mesh::Triangle own;
            for (int corner = 0; corner < 3; ++corner) {
                uint32_t& number = numberOf[tri[corner]];
                if (number == nowhere) {
                    number = static_cast<uint32_t>(kept.positions.size());
                    kept.positions.push_back(*position[tri[corner]]);
                    if (!positionsOnly) kept.normals.push_back(*normal[tri[corner]]);
                }
                own[corner] = number;
            }
            while (hard != c.cornerNormals.end() && hard->corner < 3 * t) ++hard;
            for (; hard != c.cornerNormals.end() && hard->corner < 3 * t + 3; ++hard)
                kept.cornerNormals.push_back(
                    {static_cast<uint32_t>(3 * kept.triangles.size()) + hard->corner % 3, hard->normal});
            kept.triangles.push_back(own);
            if (!positionsOnly) kept.origins.push_back(c.origins[t]);
            if (!c.labels.empty()) kept.labels.push_back(c.labels[t]);
        }
    }
    mesh::Mesh floor;
    floor.chunks.push_back(std::move(kept));
    return floor;
}

}  // namespace sgm::volume
