#include "modeler/volume/band.h"

#include <algorithm>
#include <span>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/region.h"

namespace sgm::volume {
namespace {

/// Blocks whose ranges are taken in one call: enough for SIMD, few enough to share out.
constexpr size_t batchBlocks = 16;
constexpr int blockLeaves = mesh::blockCells / leafVoxels;  ///< along an edge
constexpr size_t leavesInBlock = blockLeaves * blockLeaves * blockLeaves;
static_assert(leavesInBlock <= 64, "one call of evaluateRanges takes 64 boxes");

/// Blocks with surface and all that touch them, in order of (z, y, x).
std::vector<Vec3i> withNeighbours(const std::vector<mesh::Block>& blocks) {
    std::vector<Vec3i> all;
    all.reserve(27 * blocks.size());
    for (const mesh::Block& block : blocks)
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) all.push_back(block.index + Vec3i{x, y, z});
    std::sort(all.begin(), all.end(), mesh::zyxLess);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

/// The samples of one worker's blocks.
class BandSampler {
public:
    BandSampler(const eval::Tape& whole, const mesh::Grid& grid, float band_m, const Progress* progress)
        : whole_(whole), grid_(grid), band_m_(band_m), progress_(progress) {}

    /// The blocks' own tapes hold inside their boxes only; these reach a voxel beyond, so each block's tape is cut
    /// anew. What is left out once the watcher cancels is nobody's loss.
    std::vector<BandLeaf> sample(std::span<const Vec3i> blocks) {
        std::vector<Box3f> boxes;
        for (const Vec3i& b : blocks) boxes.push_back(voxelBox(b * mesh::blockCells, mesh::blockCells));
        eval::FloatInterval ranges[batchBlocks];
        const eval::RangeTrace trace = eval::evaluateRanges(whole_, {boxes.data(), boxes.size()}, ranges, workspace_);
        std::vector<std::pair<Vec3i, eval::Tape>> kept;
        for (size_t i = 0; i < blocks.size() && !cancelled(progress_); ++i)
            if (meetsBand(ranges[i])) kept.emplace_back(blocks[i], eval::shorten(whole_, trace, i, workspace_));
        std::vector<BandLeaf> leaves;
        for (const auto& [block, tape] : kept) sampleBlock(block * mesh::blockCells, tape, leaves);
        return leaves;
    }

private:
    /// The box of the voxels [corner, corner + size) and of those next to them.
    Box3f voxelBox(Vec3i corner, int size) const {
        return {grid_.corner(corner.x - 1, corner.y - 1, corner.z - 1),
                grid_.corner(corner.x + size, corner.y + size, corner.z + size)};
    }
    bool meetsBand(eval::FloatInterval r) const { return !(r.lo >= band_m_) && !(r.hi <= -band_m_); }

    void sampleBlock(Vec3i corner, const eval::Tape& tape, std::vector<BandLeaf>& leaves) {
        Vec3i corners[leavesInBlock];
        Box3f boxes[leavesInBlock];
        size_t n = 0;
        for (int z = 0; z < blockLeaves; ++z)
            for (int y = 0; y < blockLeaves; ++y)
                for (int x = 0; x < blockLeaves; ++x, ++n) {
                    corners[n] = corner + Vec3i{x, y, z} * leafVoxels;
                    boxes[n] = voxelBox(corners[n], leafVoxels);
                }
        eval::FloatInterval ranges[leavesInBlock];
        const eval::RangeTrace trace = eval::evaluateRanges(tape, {boxes, n}, ranges, workspace_);
        for (size_t i = 0; i < n && !cancelled(progress_); ++i)
            if (meetsBand(ranges[i]))
                leaves.push_back(sampleLeaf(corners[i], eval::shorten(tape, trace, i, workspace_)));
    }

    BandLeaf sampleLeaf(Vec3i corner, const eval::Tape& tape) {
        size_t n = 0;
        for (int i = 0; i < leafVoxels; ++i)
            for (int j = 0; j < leafVoxels; ++j)
                for (int k = 0; k < leafVoxels; ++k, ++n) {
                    const Vec3f p = grid_.corner(corner.x + i, corner.y + j, corner.z + k);
                    x_[n] = p.x;
                    y_[n] = p.y;
                    z_[n] = p.z;
                }
        BandLeaf leaf{corner, {}};
        eval::evaluate(tape, {x_.data(), y_.data(), z_.data(), n}, leaf.values.data(), workspace_);
        // What compares with nothing counts as outside.
        for (float& v : leaf.values) v = v < band_m_ ? std::max(v, -band_m_) : band_m_;
        return leaf;
    }

    const eval::Tape& whole_;
    const mesh::Grid& grid_;
    float band_m_;
    const Progress* progress_;
    eval::Workspace workspace_;
    std::array<float, 512> x_, y_, z_;
};

}  // namespace

Result<std::vector<std::vector<BandLeaf>>> sampleBand(const std::vector<mesh::Block>& blocks, const eval::Tape& whole,
                                                      const mesh::Grid& grid, float band_m, int threads,
                                                      Progress* progress) {
    const std::vector<Vec3i> all = withNeighbours(blocks);
    const size_t batches = (all.size() + batchBlocks - 1) / batchBlocks;
    std::vector<std::vector<BandLeaf>> leaves(batches);
    std::vector<BandSampler> samplers;
    for (int i = 0; i < threadCount(threads); ++i) samplers.emplace_back(whole, grid, band_m, progress);
    if (progress) progress->begin("sample volume", batches);
    parallelFor(batches, threads, progress, [&](size_t batch, int worker) {
        const size_t first = batch * batchBlocks;
        const std::span<const Vec3i> part(all.data() + first, std::min(batchBlocks, all.size() - first));
        leaves[batch] = samplers[static_cast<size_t>(worker)].sample(part);
        tick(progress);
    });
    if (cancelled(progress)) return cancelledError();
    return leaves;
}

}  // namespace sgm::volume
