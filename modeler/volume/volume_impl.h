// What a Volume holds. Includes OpenVDB: for this module's .cpp files only.
#pragma once

#include <openvdb/openvdb.h>

#include "modeler/volume/volume.h"

namespace sgm::volume {

struct Volume::Impl {
    openvdb::FloatGrid::Ptr grid;  ///< its transform takes voxel indices to metres
};

}  // namespace sgm::volume
