// Meshes that collide, beside the mesh that is seen, and what game engines call them.
// Enters: colliders in metres, in the object's frame. Leaves: names. Assumes closed meshes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"

namespace sgm::exporter {

/// A closed mesh that collides.
struct Collider {
    std::vector<Vec3f> positions;           ///< metres
    std::vector<mesh::Triangle> triangles;  ///< indices of positions, counter-clockwise seen from outside
    bool convex = true;
};

/// What `engine`, "godot", "unreal" or "unity", reads as the collider number `index` of the mesh `meshName`.
/// Godot 3 and 4: "NAME_07-convcolonly", a static body with a convex shape, or "NAME_07-colonly", one with a shape of
/// triangles. Unreal: "UCX_NAME_07", which is always taken as convex. Unity imports no colliders: "NAME_collider_07",
/// for a script to find.
std::string colliderName(std::string_view engine, const std::string& meshName, size_t index, bool convex);

}  // namespace sgm::exporter
