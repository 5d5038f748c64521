// What a cave is like for someone who walks through it: spaces, rooms and the passages between them, floors, ways.
// Enters: a level set of rock with air in it, or of the hollow itself. Leaves: figures in metres and where each was
// found. Assumes Y up; all lengths are good to a voxel.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "modeler/core/conventions.h"
#include "modeler/mesh/mesh.h"
#include "modeler/volume/air.h"

namespace sgm::volume {

/// Who walks: an upright capsule.
struct Agent {
    double radius_m = 0.3;
    double height_m = 1.8;             ///< at least twice the radius
    double slope_rad = radians(45.0);  ///< of the steepest floor
    double step_m() const { return height_m / 4; }
};

/// A place where the clearance is greatest, and what lies around it down to a neck of three quarters of its radius.
struct Room {
    Vec3f at;
    float radius_m = 0;  ///< of the largest ball in it; at least the agent's
    uint32_t space = 0;
};

/// The widest way between two rooms that touch. The rooms of a space and its passages make a tree: of all ways the
/// best.
struct Passage {
    uint32_t rooms[2] = {0, 0};
    Vec3f at;            ///< its narrowest place
    float radius_m = 0;  ///< there
    bool passable = false;
};

/// An opening in the sides of the rock's bounding box.
struct Entrance {
    Vec3f at;
    uint32_t face = 0;  ///< 0 … 5: +x -x +y -y +z -z, the side with most of it
    double area_m2 = 0;
    float radius_m = 0;      ///< of the largest ball in the opening
    float bottleneck_m = 0;  ///< narrowest place on the best way from here to the largest room of its space
    uint32_t space = 0;
};

/// Air that hangs together and holds the agent's ball.
struct Space {
    double volume_m3 = 0;
    uint32_t rooms = 0, entrances = 0;
};

/// One square of floor on which the agent can stand.
struct FloorCell {
    int32_t x = 0, z = 0;  ///< column of voxels
    float y_m = 0;         ///< height of the floor
};

/// The floor of a cave, and walks on it.
struct CaveFloor {
    static constexpr int slopeClasses_deg[4] = {15, 30, 45, 60};  ///< steeper is wall
    double floor_m2[4] = {};                                      ///< of each class, down to the one before
    struct Headroom {
        float least_m = 0, median_m = 0, greatest_m = 0;
    } headroom;              ///< over floors not too steep, under a roof, where the agent's ball fits; 0: nowhere
    double walkable_m2 = 0;  ///< floor on which the agent can stand
    uint32_t walkParts = 0;  ///< parts of that floor with no walk between them
    double reachable_m2 =
        0;  ///< of it, what can be walked to from an entrance; from the largest part where none has floor
    double longestWalk_m = 0;         ///< longest shortest walk on the reachable floor
    std::vector<FloorCell> walkable;  ///< ordered by (x, z, y)
};

struct Cave : CaveFloor {
    Agent agent;
    Vec3f origin;  ///< of column (0, 0), metres
    float voxel_m = 0;
    double air_m3 = 0;
    std::vector<Space> spaces;  ///< largest first
    uint32_t pockets = 0;       ///< air spaces too small for the agent
    std::vector<Room> rooms;    ///< largest first
    std::vector<Passage> passages;
    std::vector<Entrance> entrances;  ///< largest first

    double longestPath_m = 0;  ///< longest shortest way of the agent's ball through the air, along the grid

    /// Narrowest place on the best ways between the rooms and entrances of the largest space; infinite with one room
    /// and no entrance.
    float narrowest_m() const;
};

/// By place on the rock's surface, metres: whether it can be floor.
using FloorFilter = std::function<std::vector<bool>(std::span<const Vec3f> places)>;

/// Surveys the air; `hollow` as in `airOf`. What `isFloor` refuses is no floor, of whatever slope. Error::Usage for an
/// agent that can't be, Error::Cancelled.
Result<Cave> surveyCave(const Volume& level, const Agent& agent, bool hollow, Progress* progress,
                        const FloorFilter& isFloor = {});

/// The part of `mesh` that is floor the agent can stand on: a sheet with borders, in one chunk, of positions
/// only where `mesh` is.
/// Triangles that are walkable in part are halved down to a voxel, edge to edge. O(triangles + columns of the
/// boxes around those that are halved, each round).
mesh::Mesh walkableFloor(const mesh::Mesh& mesh, const Cave& cave);

}  // namespace sgm::volume
