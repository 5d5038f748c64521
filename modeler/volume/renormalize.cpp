// Redistancing by exact distances to the triangles of the isosurface. OpenVDB's own ways were measured beside it
// (docs/programs.md): fast sweeping (sdfToSdf) takes the distances next to the isosurface from crossings along the axes
// alone and is off even on a sphere, the Eikonal flow of LevelSetTracker rounds edges, levelSetRebuild flips signs.
#include "modeler/volume/renormalize.h"

#include <fmt/format.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "modeler/core/parallel.h"
#include "modeler/volume/leaf_distances.h"
#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int leafSide = static_cast<int>(Leaf::DIM);

/// Calls f(origin, leaves away) for all leaves up to `reach` away from the one at `origin`.
template <class F>
void forAround(Coord origin, int reach, const F& f) {
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
            for (int k = -reach; k <= reach; ++k)
                f(origin.offsetBy(leafSide * i, leafSide * j, leafSide * k), Vec3i{i, j, k});
}

std::vector<Coord> sortedOnce(std::vector<Coord> origins) {
    std::sort(origins.begin(), origins.end());
    origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
    return origins;
}

CornerValues cornerValues(const FloatGrid::ConstAccessor& grid, Coord origin) {
    CornerValues values;
    size_t n = 0;
    for (int i = 0; i < cellCorners; ++i)
        for (int j = 0; j < cellCorners; ++j)
            for (int k = 0; k < cellCorners; ++k) values[n++] = grid.getValue(origin.offsetBy(i, j, k));
    return values;
}

/// A level set's isosurface by leaf.
class Surfaces {
public:
    /// A cell with triangles has a corner in a leaf of the grid, since the grid has leaves wherever the sign changes.
    Surfaces(const FloatGrid& grid, int threads, Progress* progress) {
        std::vector<Coord> origins;
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
            for (int below = 0; below < 8; ++below)
                origins.push_back(leaf->origin().offsetBy(-leafSide * (below & 1), -leafSide * (below >> 1 & 1),
                                                          -leafSide * (below >> 2 & 1)));
        origins_ = sortedOnce(std::move(origins));
        surfaces_.resize(origins_.size());
        if (progress) progress->begin("isosurface", origins_.size());
        std::vector<FloatGrid::ConstAccessor> values(static_cast<size_t>(threadCount(threads)),
                                                     grid.getConstAccessor());
        parallelFor(origins_.size(), threads, progress, [&](size_t n, int worker) {
            surfaces_[n] = isosurface(cornerValues(values[static_cast<size_t>(worker)], origins_[n]));
            tick(progress);
        });
        for (size_t n = 0; n < origins_.size(); ++n)
            if (!surfaces_[n].begin.empty()) numbers_.emplace(origins_[n], n);
    }

    /// Null where the leaf has no triangles.
    const LeafSurface* at(Coord origin) const {
        const auto found = numbers_.find(origin);
        return found == numbers_.end() ? nullptr : &surfaces_[found->second];
    }
    /// The leaves up to `reach` leaves away from one with triangles, in ascending order.
    std::vector<Coord> around(int reach) const {
        std::vector<Coord> origins;
        for (size_t n = 0; n < origins_.size(); ++n)
            if (!surfaces_[n].begin.empty())
                forAround(origins_[n], reach, [&](Coord origin, Vec3i) { origins.push_back(origin); });
        return sortedOnce(std::move(origins));
    }

private:
    std::vector<Coord> origins_;
    std::vector<LeafSurface> surfaces_;
    std::unordered_map<Coord, size_t> numbers_;
};

/// Makes leaves; one a worker.
class LeafMaker {
public:
    LeafMaker(const FloatGrid& grid, const Surfaces& surfaces, int halfWidth)
        : grid_(grid.getConstAccessor()),
          surfaces_(surfaces),
          halfWidth_(halfWidth),
          distances_(halfWidth),
          voxel_m_(static_cast<float>(grid.voxelSize()[0])),
          band_m_(grid.background()) {}

    /// The leaf with its distances, active within the band; null where no voxel is.
    std::unique_ptr<Leaf> leaf(Coord origin) {
        distances_.clear();
        forAround(origin, LeafDistances::reach(halfWidth_), [&](Coord at, Vec3i leaves) {
            if (const LeafSurface* const surface = surfaces_.at(at)) distances_.add(*surface, leaves);
        });
        if (distances_.empty()) return nullptr;
        auto made = std::make_unique<Leaf>(origin, band_m_, false);
        const auto& distances = distances_.distances();
        for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
            const float distance_m = voxel_m_ * distances[n];
            const bool banded = distance_m < band_m_;
            const bool inside = grid_.getValue(origin + Leaf::offsetToLocalCoord(n)) < 0;
            // The sign stays even where the isosurface goes through the voxel's centre.
            const float value = banded ? std::max(distance_m, inside ? 1e-6f * voxel_m_ : 0.0f) : band_m_;
            made->setValueOnly(n, inside ? -value : value);
            if (banded) made->setValueOn(n);
        }
        return made->isEmpty() ? nullptr : std::move(made);
    }

private:
    FloatGrid::ConstAccessor grid_;
    const Surfaces& surfaces_;
    int halfWidth_;
    LeafDistances distances_;
    float voxel_m_, band_m_;
};

}  // namespace

Result<Volume> renormalize(const Volume& level, int threads, Progress* progress) {
    const FloatGrid& grid = *level.impl().grid;
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET)
        return Error{Error::Kind::Usage, "only a level set can be renormalised"};
    const int halfWidth = std::max(1, static_cast<int>(std::ceil(grid.background() / grid.voxelSize()[0] - 1e-3)));
    if (halfWidth > widestBand)
        return Error{Error::Kind::Usage,
                     fmt::format("a band of {} voxels: up to {} can be renormalised", halfWidth, widestBand)};
    const Surfaces surfaces(grid, threads, progress);
    if (cancelled(progress)) return cancelledError();

    const std::vector<Coord> origins = surfaces.around(LeafDistances::reach(halfWidth));
    std::vector<std::unique_ptr<Leaf>> leaves(origins.size());
    std::vector<LeafMaker> makers(static_cast<size_t>(threadCount(threads)), {grid, surfaces, halfWidth});
    if (progress) progress->begin("distances", origins.size());
    parallelFor(origins.size(), threads, progress, [&](size_t n, int worker) {
        leaves[n] = makers[static_cast<size_t>(worker)].leaf(origins[n]);
        tick(progress);
    });
    if (cancelled(progress)) return cancelledError();

    const FloatGrid::Ptr result = grid.copyWithNewTree();
    for (auto& leaf : leaves)
        if (leaf) result->tree().addLeaf(leaf.release());
    // Leaves (level 0) have all their signs already.
    openvdb::tools::signedFloodFill(result->tree(), threadCount(threads) > 1, 1, 1);
    return Volume(std::make_shared<Volume::Impl>(Volume::Impl{result}));
}

}  // namespace sgm::volume
