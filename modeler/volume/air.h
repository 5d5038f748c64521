// The air in a rock as a graph of voxels, with its clearance. No OpenVDB here.
// Enters: a level set of rock, or of the hollow itself. Leaves: air voxels, each with its six neighbours and its
// distance to the rock. Assumes that the rock's bounding box parts inside from outside: air beyond it belongs to no
// cave.
#pragma once

#include <array>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/volume/volume.h"

namespace sgm::volume {

inline constexpr uint32_t nowhere = UINT32_MAX;

/// Air voxels in order of (x, z, y), so that a column's voxels follow each other upward.
struct Air {
    Vec3f origin;  ///< of voxel (0, 0, 0), metres
    float voxel_m = 1;
    std::vector<Vec3i> voxels;
    std::vector<float> clearance_m;  ///< distance to the rock: the radius of the largest ball around the voxel
    std::vector<std::array<uint32_t, 6>> next;  ///< neighbours toward +x -x +y -y +z -z, or `nowhere`
    std::vector<uint8_t> rim;    ///< bit d: the voxel lies in the box's outermost layer toward d, all clear there
    std::vector<float> floor_m;  ///< height of the rock's surface right below; NaN where none is
    std::vector<float> roof_m;   ///< the same right above

    size_t size() const { return voxels.size(); }
    Vec3f place(uint32_t id) const { return origin + voxels[id].as<float>() * voxel_m; }
};

/// `hollow`: the level set's inside is the air, the rock around it without end. Clearance is the distance to points
/// of the rock's surface, found in the order of the eikonal equation's solution (OpenVDB's fast sweeping, Zhao 2005),
/// so noise and morphs, whose fields grow slower than a distance, count in metres. Error::Budget for more than 2²⁶ air
/// voxels.
Result<Air> airOf(const Volume& level, bool hollow, Progress* progress);

}  // namespace sgm::volume
