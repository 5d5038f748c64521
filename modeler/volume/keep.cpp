// Connected components by union-find over runs of voxels (Rosenfeld and Pfaltz 1966), eight to a column of a leaf.
#include "modeler/volume/keep.h"

#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tree/LeafManager.h>

#include <bit>
#include <unordered_map>

#include "modeler/mesh/components.h"
#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

using openvdb::BoolTree;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;

constexpr uint64_t mostVoxelsOfBox = uint64_t{1} << 28;
constexpr uint32_t columns = 64;  ///< of a leaf, along z: column x · 8 + y

/// The parts of a mask that hang together by faces. The mask has no active tiles and must outlive this. OpenVDB's
/// segmentActiveVoxels makes a tree for each, which takes five times the processor time where there is dust
/// (mcgraw.sgm at 256 cells).
class Parts {
public:
    explicit Parts(const BoolTree& mask) {
        for (auto leaf = mask.cbeginLeaf(); leaf; ++leaf) {
            numbers_.emplace(leaf->origin(), static_cast<uint32_t>(leaves_.size()));
            leaves_.push_back(leaf.getLeaf());
        }
        for (const auto* leaf : leaves_)
            for (uint32_t c = 0; c < columns; ++c) {
                first_.push_back(runs_);
                runs_ += static_cast<uint32_t>(std::popcount(starts(column(*leaf, c))));
            }
        mesh::Components runs(runs_);
        for (uint32_t n = 0; n < leaves_.size(); ++n) joinLeaf(n, runs);
        part_.resize(runs_);
        for (uint32_t run = 0; run < runs_; ++run) {
            const uint32_t root = runs.find(run);  // the lowest of its part
            part_[run] = root == run ? count_++ : part_[root];
        }
    }
    uint32_t count() const { return count_; }

    /// Calls f(leaf, column, first z, voxels, part) for every run.
    template <class F>
    void forRuns(const F& f) const {
        for (uint32_t n = 0; n < leaves_.size(); ++n)
            for (uint32_t c = 0; c < columns; ++c) {
                uint32_t run = first_[n * columns + c];
                for (unsigned bits = column(*leaves_[n], c); bits != 0;) {
                    const int z = std::countr_zero(bits), voxels = std::countr_one(bits >> z);
                    f(*leaves_[n], c, z, voxels, part_[run++]);
                    bits &= ~(((1u << voxels) - 1) << z);
                }
            }
    }

private:
    using Leaf = BoolTree::LeafNodeType;
    static uint8_t column(const Leaf& leaf, uint32_t c) { return leaf.getValueMask().getWord<uint8_t>(c); }
    static unsigned starts(unsigned bits) { return bits & ~(bits << 1); }
    uint32_t runAt(uint32_t leaf, uint32_t c, int z) const {
        const unsigned upTo = starts(column(*leaves_[leaf], c)) & ((2u << z) - 1);
        return first_[leaf * columns + c] + static_cast<uint32_t>(std::popcount(upTo)) - 1;
    }
    void joinColumns(uint32_t a, uint32_t ca, uint32_t b, uint32_t cb, mesh::Components& runs) const {
        for (unsigned both = starts(column(*leaves_[a], ca) & column(*leaves_[b], cb)); both != 0; both &= both - 1) {
            const int z = std::countr_zero(both);
            runs.join(runAt(a, ca, z), runAt(b, cb, z));
        }
    }
    void joinLeaf(uint32_t n, mesh::Components& runs) const {
        const Coord at = leaves_[n]->origin();
        const auto beside = [&](int x, int y, int z) {
            const auto found = numbers_.find(at.offsetBy(x, y, z));
            return found == numbers_.end() ? UINT32_MAX : found->second;
        };
        const uint32_t right = beside(8, 0, 0), above = beside(0, 8, 0), behind = beside(0, 0, 8);
        for (uint32_t c = 0; c < columns; ++c) {
            if (c < 56)
                joinColumns(n, c, n, c + 8, runs);
            else if (right != UINT32_MAX)
                joinColumns(n, c, right, c - 56, runs);
            if (c % 8 < 7)
                joinColumns(n, c, n, c + 1, runs);
            else if (above != UINT32_MAX)
                joinColumns(n, c, above, c - 7, runs);
            if (behind != UINT32_MAX && column(*leaves_[n], c) >> 7 && (column(*leaves_[behind], c) & 1))
                runs.join(runAt(n, c, 7), runAt(behind, c, 0));
        }
    }

    std::vector<const Leaf*> leaves_;
    std::unordered_map<Coord, uint32_t> numbers_;
    std::vector<uint32_t> first_;  ///< run of every leaf's columns
    std::vector<uint32_t> part_;   ///< of every run
    uint32_t runs_ = 0, count_ = 0;
};

/// The voxels of those parts.
BoolTree::Ptr only(const Parts& parts, const std::vector<bool>& wanted) {
    auto mask = std::make_shared<BoolTree>(false);
    openvdb::tree::ValueAccessor<BoolTree> at(*mask);
    parts.forRuns([&](const auto& leaf, uint32_t c, int z, int voxels, uint32_t part) {
        if (!wanted[part]) return;
        auto* into = at.touchLeaf(leaf.origin());
        for (int i = z; i < z + voxels; ++i) into->setValueOn(c * 8 + static_cast<uint32_t>(i));
    });
    return mask;
}

/// The solids that stay.
BoolTree::Ptr solidsOf(const BoolTree& inside, mesh::Keep keep, double voxel_m, float slack_m) {
    const Parts parts(inside);
    std::vector<mesh::ConnectedComponent> solids(parts.count());
    parts.forRuns([&](const auto& leaf, uint32_t c, int, int voxels, uint32_t part) {
        const auto y = static_cast<float>(voxel_m * (leaf.origin().y() + static_cast<int>(c % 8)));
        solids[part].bounds = hull(solids[part].bounds, Vec3f{0, y, 0});
        solids[part].volume_m3 += voxels * voxel_m * voxel_m * voxel_m;
    });
    return only(parts, mesh::selectKept(std::move(solids), keep, slack_m));
}

/// Adds the air that no way leads to.
void fillCavities(BoolTree& solid) {
    CoordBBox box;
    solid.evalActiveVoxelBoundingBox(box);
    box.expand(1);
    BoolTree air(false);
    air.fill(box, true, true);
    air.voxelizeActiveTiles();
    air.topologyDifference(solid);
    const Parts parts(air);
    std::vector<bool> closed(parts.count(), true);
    parts.forRuns([&](const auto& leaf, uint32_t c, int z, int, uint32_t part) {
        if (leaf.origin() + Coord(static_cast<int>(c / 8), static_cast<int>(c % 8), z) == box.min())
            closed[part] = false;
    });
    solid.topologyUnion(*only(parts, closed));
}

/// Signs as `solid` has them, and a band of `voxels` to both sides of its surface.
void setSigns(FloatGrid& grid, const BoolTree& solid, int voxels) {
    BoolTree near(solid), deep(solid);
    openvdb::tools::dilateActiveValues(near, voxels, openvdb::tools::NN_FACE_EDGE_VERTEX, openvdb::tools::IGNORE_TILES);
    openvdb::tools::erodeActiveValues(deep, voxels, openvdb::tools::NN_FACE_EDGE_VERTEX, openvdb::tools::IGNORE_TILES);
    const float band = grid.background();
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(grid.tree());
    leaves.foreach ([&](auto& leaf, size_t) {
        const auto *in = solid.probeConstLeaf(leaf.origin()), *around = near.probeConstLeaf(leaf.origin()),
                   *core = deep.probeConstLeaf(leaf.origin());
        for (openvdb::Index i = 0; i < leaf.SIZE; ++i) {
            const float sign = in && in->isValueOn(i) ? -1.0f : 1.0f;
            const bool banded = leaf.isValueOn(i) && around && around->isValueOn(i) && !(core && core->isValueOn(i));
            leaf.setValueOnly(i, sign * (banded ? std::abs(leaf.getValue(i)) : band));
            leaf.setActiveState(i, banded);
        }
    });
    openvdb::tools::signedFloodFill(grid.tree(), true, 1, 1);
    openvdb::tools::pruneLevelSet(grid.tree());
}

}  // namespace

Status keepOnly(Volume& level, mesh::Keep keep, float slack_m, Progress* progress) {
    FloatGrid& grid = *level.impl().grid;
    if (keep == mesh::Keep::All || grid.tree().leafCount() == 0) return Done{};
    if (progress) progress->begin("keep", 3);
    const openvdb::BoolGrid::Ptr inside = openvdb::tools::sdfInteriorMask(grid);
    if (inside->tree().empty()) return Done{};
    if (inside->evalActiveVoxelBoundingBox().volume() > mostVoxelsOfBox)
        return Error{Error::Kind::Budget, "more than 2^28 voxels to look for what floats: choose a larger --cell"};
    inside->tree().voxelizeActiveTiles();
    tick(progress);
    if (cancelled(progress)) return cancelledError();
    const BoolTree::Ptr solid = solidsOf(inside->tree(), keep, grid.voxelSize()[0], slack_m);
    fillCavities(*solid);
    tick(progress);
    if (cancelled(progress)) return cancelledError();
    setSigns(grid, *solid, static_cast<int>(std::lround(grid.background() / grid.voxelSize()[0])));
    tick(progress);
    return Done{};
}

}  // namespace sgm::volume
