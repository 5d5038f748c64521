#include "modeler/volume/dense.h"

#include <openvdb/tools/Dense.h>

#include "modeler/volume/volume_impl.h"

namespace sgm::volume {

Result<Dense> dense(const Volume& volume, int border) {
    const openvdb::FloatGrid& grid = *volume.impl().grid;
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) return Error{Error::Kind::Input, "the volume is empty"};
    box.expand(border);
    if (box.volume() > uint64_t(1) << 28)
        return Error{Error::Kind::Budget, "the volume has more than 2²⁸ voxels; take larger cells"};
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> array(box);
    openvdb::tools::copyToDense(grid, array);
    const openvdb::Coord size = box.dim();
    const openvdb::Vec3d low = grid.indexToWorld(box.min());
    return Dense{{size.x(), size.y(), size.z()},
                 Vec3d{low.x(), low.y(), low.z()}.as<float>(),
                 volume.voxel_m(),
                 std::vector<float>(array.data(), array.data() + box.volume())};
}

}  // namespace sgm::volume
