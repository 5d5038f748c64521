// A volume as a plain array, for a texture. No OpenVDB here.
// Enters: a volume. Leaves: its active box, every voxel of it. Assumes that it fits into memory several times.
#pragma once

#include "modeler/volume/volume.h"

namespace sgm::volume {

struct Dense {
    Vec3i count;  ///< voxels along x, y, z
    Vec3f low;    ///< place of voxel (0, 0, 0), metres
    float voxel_m = 1;
    std::vector<float> values;  ///< x runs fastest, then y

    size_t index(int x, int y, int z) const {
        return (size_t(z) * size_t(count.y) + size_t(y)) * size_t(count.x) + size_t(x);
    }
};

/// The box of the active voxels and `border` more to each side. Error::Input where nothing is active, Error::Budget for
/// more than 2²⁸ voxels.
Result<Dense> dense(const Volume& volume, int border);

}  // namespace sgm::volume
