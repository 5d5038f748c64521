#include "modeler/volume/cave.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "modeler/volume/cave_parts.h"

namespace sgm::volume {
namespace {

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

}  // namespace sgm::volume
