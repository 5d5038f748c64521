#include "modeler/volume/air.h"

#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

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

/// How far below (or above) an air voxel the rock begins, in voxels 0 … 1: from the depths of the two rock voxels next
/// there, which no wall beside the air comes near; where the rock is too thin for that, between the voxel's clearance
/// and the first depth. All three as sampled: distances swept anew are rough in the corner between floor and wall.
float wayToRock(float clearance, float depth, float deeper, float voxel_m) {
    const float growth = deeper - depth;
    if (growth > 0.3f * voxel_m) return std::clamp(1 - depth / growth, 0.0f, 1.0f);
    return clearance / (clearance + std::max(depth, 1e-6f * voxel_m));
}

/// Where the rock's surface crosses the ways from an air voxel to its neighbours in the rock, in voxels; calls
/// visit(point).
template <class Visit>
void visitSurfaceBeside(const Air& air, uint32_t voxel, const FloatGrid::ConstAccessor& sampled, float sign,
                        Visit&& visit) {
    const Vec3f centre = air.voxels[voxel].as<float>();
    const Coord c = coordOf(air.voxels[voxel]);
    const float own = std::max(sign * sampled.getValue(c), 0.0f);
    for (size_t d = 0; d < 6; ++d) {
        if (air.next[voxel][d] != nowhere || (air.rim[voxel] >> d & 1)) continue;
        const float depth = std::max(-sign * sampled.getValue(c + steps[d]), 1e-6f * air.voxel_m);
        const float share = own / (own + depth);
        visit(centre + Vec3f{float(steps[d].x()), float(steps[d].y()), float(steps[d].z())} * share);
    }
}

/// Replaces clearances, which the sweep finds up to two voxels too small where fronts meet, by distances to points of
/// the surface: every voxel takes that of the nearest one that a neighbour of less clearance knows (Danielsson,
/// "Euclidean distance mapping", 1980, in the order of the sweep). O(n log n).
void refineClearance(Air& air, const FloatGrid::ConstAccessor& sampled, float sign, const Progress* progress) {
    std::vector<uint32_t> order(air.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::pair(air.clearance_m[a], a) < std::pair(air.clearance_m[b], b);
    });
    constexpr float unknown = std::numeric_limits<float>::infinity();
    std::vector<Vec3f> nearest(air.size());
    std::vector<float> squared(air.size(), unknown);
    for (int round = 0; round < 2 && !cancelled(progress); ++round)
        for (const uint32_t v : order) {
            const auto take = [&](Vec3f point) {
                const Vec3f way = point - air.voxels[v].as<float>();
                if (const float d = dot(way, way); d < squared[v]) squared[v] = d, nearest[v] = point;
            };
            if (round == 0) visitSurfaceBeside(air, v, sampled, sign, take);
            for (const uint32_t n : air.next[v])
                if (n != nowhere && squared[n] < unknown) take(nearest[n]);
        }
    for (uint32_t v = 0; v < air.size(); ++v)
        if (squared[v] < unknown) air.clearance_m[v] = std::sqrt(squared[v]) * air.voxel_m;
}

void measure(Air& air, const FloatGrid& level, const FloatGrid& distance, const CoordBBox& box, bool hollow,
             const Progress* progress) {
    const FloatGrid::ConstAccessor at = distance.getConstAccessor(), sampled = level.getConstAccessor();
    const float sign = hollow ? -1 : 1;
    air.clearance_m.resize(air.size());
    air.rim.assign(air.size(), 0);
    air.floor_m.resize(air.size()), air.roof_m.resize(air.size());
    for (uint32_t i = 0; i < air.size(); ++i) {
        const Coord c = coordOf(air.voxels[i]);
        const float own = sign * at.getValue(c);
        air.clearance_m[i] = own;
        for (int axis = 0; axis < 3 && !hollow; ++axis) {
            if (c[axis] == box.max()[axis]) air.rim[i] |= static_cast<uint8_t>(1u << 2 * axis);
            if (c[axis] == box.min()[axis]) air.rim[i] |= static_cast<uint8_t>(2u << 2 * axis);
        }
        const auto rockToward = [&](size_t d) {
            if (air.next[i][d] != nowhere || (air.rim[i] >> d & 1)) return std::numeric_limits<float>::quiet_NaN();
            const Coord& step = steps[d];
            const float share = wayToRock(sign * sampled.getValue(c), -sign * sampled.getValue(c + step),
                                          -sign * sampled.getValue(c + step + step), air.voxel_m);
            return air.place(i).y + air.voxel_m * share * static_cast<float>(step.y());
        };
        air.roof_m[i] = rockToward(2), air.floor_m[i] = rockToward(3);
    }
    refineClearance(air, sampled, sign, progress);
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
    if (air.size() > 0) measure(air, grid, *distances(grid, *space), box, hollow, progress);
    tick(progress);
    if (cancelled(progress)) return cancelledError();
    return air;
}

}  // namespace sgm::volume
