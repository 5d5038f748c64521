#include "modeler/volume/air.h"

#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

using openvdb::BoolGrid;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;

constexpr uint64_t mostVoxels = uint64_t{1} << 26;
/// +x -x +y -y +z -z, as in conventions.h.
const Coord steps[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

Coord coordOf(Vec3i v) { return {v.x, v.y, v.z}; }

/// Signed distance in all of the band and the air, negative in the level set's inside.
FloatGrid::Ptr distances(const FloatGrid& level, const BoolGrid& air) {
    const FloatGrid::Ptr rough = level.deepCopy();
    rough->tree().topologyUnion(air.tree());
    rough->tree().voxelizeActiveTiles();
    return openvdb::tools::sdfToSdf(*rough);
}

void link(Air& air) {
    openvdb::Int32Tree index(-1);
    openvdb::tree::ValueAccessor<openvdb::Int32Tree> at(index);
    for (size_t i = 0; i < air.size(); ++i) at.setValue(coordOf(air.voxels[i]), static_cast<int32_t>(i));
    air.next.resize(air.size());
    for (size_t i = 0; i < air.size(); ++i)
        for (size_t d = 0; d < 6; ++d)
            air.next[i][d] = static_cast<uint32_t>(at.getValue(coordOf(air.voxels[i]) + steps[d]));
}

/// How far below an air voxel the rock begins, in voxels 0 … 1: from the depths of the two rock voxels below it, which
/// no wall beside the air comes near; where the rock is too thin for that, between the voxel's clearance and the first
/// depth. All three as sampled: distances swept anew are rough in the corner between floor and wall.
float depthOfFloor(float clearance, float depth, float deeper, float voxel_m) {
    const float growth = deeper - depth;
    if (growth > 0.3f * voxel_m) return std::clamp(1 - depth / growth, 0.0f, 1.0f);
    return clearance / (clearance + std::max(depth, 1e-6f * voxel_m));
}

void measure(Air& air, const FloatGrid& level, const FloatGrid& distance, const CoordBBox& box, bool hollow) {
    const FloatGrid::ConstAccessor at = distance.getConstAccessor(), sampled = level.getConstAccessor();
    const float sign = hollow ? -1 : 1;
    air.clearance_m.resize(air.size());
    air.rim.assign(air.size(), 0);
    air.floor_m.assign(air.size(), std::numeric_limits<float>::quiet_NaN());
    for (uint32_t i = 0; i < air.size(); ++i) {
        const Coord c = coordOf(air.voxels[i]);
        const float own = sign * at.getValue(c);
        air.clearance_m[i] = own;
        for (int axis = 0; axis < 3 && !hollow; ++axis) {
            if (c[axis] == box.max()[axis]) air.rim[i] |= static_cast<uint8_t>(1u << 2 * axis);
            if (c[axis] == box.min()[axis]) air.rim[i] |= static_cast<uint8_t>(2u << 2 * axis);
        }
        if (air.next[i][3] != nowhere || (air.rim[i] & 8)) continue;
        air.floor_m[i] = air.place(i).y -
                         air.voxel_m * depthOfFloor(sign * sampled.getValue(c), -sign * sampled.getValue(c + steps[3]),
                                                    -sign * sampled.getValue(c + steps[3] + steps[3]), air.voxel_m);
    }
    // A distance can't grow faster than the way: takes away single voxels at the surface that the sweep left far.
    for (size_t i = 0; i < air.size(); ++i)
        for (const uint32_t n : air.next[i])
            if (n != nowhere) air.clearance_m[i] = std::min(air.clearance_m[i], air.clearance_m[n] + air.voxel_m);
}

}  // namespace

Result<Air> airOf(const Volume& level, bool hollow, Progress* progress) {
    const FloatGrid& grid = *level.impl().grid;
    if (progress) progress->begin("survey cave", 3);
    const BoolGrid::Ptr inside = openvdb::tools::sdfInteriorMask(grid);
    const CoordBBox box = inside->evalActiveVoxelBoundingBox();
    BoolGrid::Ptr space = inside;
    if (!hollow) {
        space = BoolGrid::create(false);
        space->tree().fill(box, true, true);
        space->tree().topologyDifference(inside->tree());
    }
    space->tree().voxelizeActiveTiles();
    if (space->activeVoxelCount() > mostVoxels)
        return Error{Error::Kind::Budget, "more than 2^26 voxels of air to survey: choose a larger --cell"};
    tick(progress);
    if (cancelled(progress)) return cancelledError();

    Air air;
    const openvdb::Vec3d origin = grid.transform().indexToWorld(Coord(0, 0, 0));
    air.origin = Vec3d{origin.x(), origin.y(), origin.z()}.as<float>();
    air.voxel_m = level.voxel_m();
    for (auto v = space->cbeginValueOn(); v; ++v)
        air.voxels.push_back({v.getCoord().x(), v.getCoord().y(), v.getCoord().z()});
    std::sort(air.voxels.begin(), air.voxels.end(),
              [](Vec3i a, Vec3i b) { return std::tie(a.x, a.z, a.y) < std::tie(b.x, b.z, b.y); });
    link(air);
    tick(progress);
    if (cancelled(progress)) return cancelledError();
    if (air.size() > 0) measure(air, grid, *distances(grid, *space), box, hollow);
    tick(progress);
    if (cancelled(progress)) return cancelledError();
    return air;
}

}  // namespace sgm::volume
