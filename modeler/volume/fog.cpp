#include "modeler/volume/fog.h"

#include <fmt/format.h>
#include <openvdb/tools/Activate.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "modeler/field/noise.h"
#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

using openvdb::FloatGrid;
using Noise = field::ops::Noise;

constexpr double mostStored = 2147483648.0;  ///< voxels: 8 GB

Status checkOptions(const Volume& volume, const FogOptions& o) {
    if (volume.impl().grid->getGridClass() != openvdb::GRID_LEVEL_SET)
        return Error{Error::Kind::Usage, "fog is made from a level set"};
    const bool good = o.density > 0 && std::isfinite(o.density) && o.edge_m >= 0 && std::isfinite(o.edge_m) &&
                      o.wisps >= 0 && o.wisps <= 0.95 && o.billow >= 0 && o.billow <= 1 && o.lump_m >= 0 &&
                      std::isfinite(o.lump_m);
    if (!good)
        return Error{Error::Kind::Usage,
                     "fog: density > 0, edge and lump at least 0 m, wisps 0 to 0.95, billow 0 to 1"};
    return Done{};
}

/// A copy whose inner band is at least `depth_m` deep.
FloatGrid::Ptr deepened(const FloatGrid& levelSet, double depth_m) {
    const double voxel = levelSet.voxelSize()[0];
    const int more = static_cast<int>(std::ceil((depth_m - levelSet.background()) / voxel));
    if (more <= 0 || levelSet.empty()) return levelSet.deepCopy();
    return openvdb::tools::dilateSdf(levelSet, more, openvdb::tools::NN_FACE, 1,
                                     openvdb::tools::FastSweepingDomain::SWEEP_LESS_THAN_ISOVALUE);
}

/// An eighth of the least extent of what is active, metres.
double usualLump_m(const FloatGrid& grid) {
    const openvdb::Coord size = grid.evalActiveVoxelDim();
    return std::max(1, std::min({size.x(), size.y(), size.z()})) * grid.voxelSize()[0] / 8;
}

/// Where a part is thinner than twice the edge its ramp ends below 1, and noise would eat all of it: there the ramp
/// rises to 1 at the part's core. Every voxel of the edge takes the value where the way up from it ends, from neighbour
/// to steepest neighbour while depth grows at least half as fast as the way: flanks lead to the core that is nearest,
/// cores to no other.
void raiseCores(FloatGrid& grid, double edge_m) {
    struct Voxel {
        openvdb::Coord at;
        float ramp;
    };
    std::vector<Voxel> edge;
    for (auto v = grid.cbeginValueOn(); v; ++v)
        if (v.isVoxelValue() && *v > 0 && *v < 1) edge.push_back({v.getCoord(), *v});
    std::sort(edge.begin(), edge.end(),
              [](const Voxel& a, const Voxel& b) { return a.ramp != b.ramp ? a.ramp > b.ramp : a.at < b.at; });
    const FloatGrid::Ptr cores = grid.deepCopy();
    const auto enough = static_cast<float>(0.5 * grid.voxelSize()[0] / edge_m);
    FloatGrid::ConstAccessor ramps = grid.getConstAccessor();
    FloatGrid::Accessor core = cores->getAccessor();
    for (const Voxel& v : edge) {
        float steepest = enough;
        openvdb::Coord to = v.at;
        for (int i = 0; i < 27; ++i) {
            const openvdb::Coord step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const double way = std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
            if (way == 0) continue;
            const float slope = (ramps.getValue(v.at + step) - v.ramp) / static_cast<float>(way);
            if (slope > steepest || ramps.getValue(v.at + step) >= 1) {
                steepest = ramps.getValue(v.at + step) >= 1 ? std::numeric_limits<float>::infinity() : slope;
                to = v.at + step;
            }
        }
        if (to != v.at) core.setValueOnly(v.at, core.getValue(to));
    }
    FloatGrid::Accessor raised = grid.getAccessor();
    for (const Voxel& v : edge) raised.setValueOnly(v.at, v.ramp / std::min(1.0f, core.getValue(v.at)));
}

/// What noise leaves of the ramp at a place.
class Vapour {
public:
    Vapour(const FogOptions& o, double lump_m)
        : density_(static_cast<float>(o.density)),
          wisps_(static_cast<float>(o.wisps)),
          billow_(static_cast<float>(o.billow)),
          perMetre_(static_cast<float>(1 / lump_m)) {}

    /// `depth` in shares of the edge; sdfToFogVolume lets those beyond it pass.
    float operator()(float depth, Vec3f p) const {
        const float ramp = std::min(1.0f, depth);
        const float eaten = wisps_ > 0 ? wisps_ * (0.5f + 0.5f * noise(p * (4 * perMetre_), wispData)) : 0;
        const float thinned = billow_ > 0 ? billow_ * noise(p * perMetre_, billowData) : 0;
        return density_ * std::max(0.0f, (ramp - eaten) / (1 - eaten)) * (1 - thinned);
    }

private:
    static inline const uint32_t wispData = Noise::pack(true, 4, 1), billowData = Noise::pack(false, 3, 2);
    static float noise(Vec3f p, uint32_t data) {
        const std::array<float, 3> at{p.x, p.y, p.z};
        return Noise::apply<float>(at, data);
    }
    float density_, wisps_, billow_, perMetre_;
};

}  // namespace

Result<Volume> fog(const Volume& levelSet, const FogOptions& options, const Progress* progress) {
    if (Status status = checkOptions(levelSet, options); !status.ok()) return status.error();
    openvdb::initialize();
    const FloatGrid& from = *levelSet.impl().grid;
    const double edge_m = options.edge_m > 0 ? options.edge_m : 3 * from.voxelSize()[0];
    const FloatGrid::Ptr grid = deepened(from, edge_m);
    if (cancelled(progress)) return cancelledError();
    openvdb::tools::sdfToFogVolume(*grid, static_cast<float>(edge_m));
    raiseCores(*grid, edge_m);
    if (cancelled(progress)) return cancelledError();
    if (options.billow > 0) {
        if (static_cast<double>(grid->activeVoxelCount()) > mostStored)
            return Error{Error::Kind::Budget,
                         "fog with billow stores every voxel inside: more than 2³¹ here; take larger cells"};
        grid->tree().voxelizeActiveTiles();
    }
    if (cancelled(progress)) return cancelledError();
    const Vapour vapour(options, options.lump_m > 0 ? options.lump_m : usualLump_m(*grid));
    openvdb::tools::foreach (grid->beginValueOn(), [&](const FloatGrid::ValueOnIter& voxel) {
        const openvdb::Vec3d p = grid->indexToWorld(voxel.getCoord());
        voxel.setValue(vapour(*voxel, Vec3d{p.x(), p.y(), p.z()}.as<float>()));
    });
    openvdb::tools::deactivate(grid->tree(), 0.0f);
    openvdb::tools::prune(grid->tree());
    if (cancelled(progress)) return cancelledError();
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return Volume(std::make_shared<Volume::Impl>(Volume::Impl{grid}));
}

}  // namespace sgm::volume
