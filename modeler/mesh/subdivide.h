// The descent from the whole box to the blocks that hold surface.
// Enters: a tape, a grid. Leaves: blocks in ascending order, each with its own shortened tape. Assumes that the tape's
// Lipschitz constant is one, and that the grid's box holds the surface with a layer of outside around it; corners on
// the grid's border count as outside whatever the field says, so what sticks out is cut off flat there and the mesh
// still closes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/core/stopwatch.h"
#include "modeler/eval/evaluate.h"

namespace sgm::mesh {

inline constexpr int blockCells = 32;   ///< SG-M III-G
inline constexpr int brickCells = 8;    ///< an OpenVDB leaf
inline constexpr int regionSplits = 4;  ///< parts of a region along an axis: 64 children make one batch of intervals

/// Where samples lie: corner (i, j, k) is at origin + cell · (i, j, k), computed in float32 so that neighbours agree.
struct Grid {
    Vec3f origin;      ///< metres
    float cell_m = 1;  ///< edge of a cell
    Vec3i cells;       ///< cells along x, y, z; whole blocks are not required

    Vec3f corner(int i, int j, int k) const {
        return {origin.x + cell_m * static_cast<float>(i), origin.y + cell_m * static_cast<float>(j),
                origin.z + cell_m * static_cast<float>(k)};
    }
};

/// The grid over `bounds` with cells of `cell_m` and 1¼ to 1¾ cells of outside on every side, so that flat faces on the
/// bounds pass between samples. No cells when the bounds are empty; one that `subdivide` refuses when they aren't
/// finite.
Grid gridFor(const Box3f& bounds, float cell_m);
/// The cell size that puts `resolution` (at least 1) cells along the longest side of `bounds`; 1 m for an empty box.
float cellFor(const Box3f& bounds, int resolution);

/// Some of a block's cells. Blocks at a side have to have the same cells and bricks at it.
struct PartOfBlock {
    int cubeCells = brickCells;  ///< cells come in cubes with 2, 4 or 8 along an edge
    uint64_t bricks = 0;         ///< those with such cubes, the seven below each, and those across sides; by number
    std::array<uint64_t, 64> cubes{};  ///< by brick: its cubes that get triangles, x first
};

struct Block {
    Vec3i index;      ///< block coordinates: cells [32·index, 32·index + 32)
    eval::Tape tape;  ///< shortened to the block, as far as the surface goes: far from it only the sign is the field's
    std::shared_ptr<const PartOfBlock> part{};  ///< null: all of it
};

/// What the descent and the sampling counted, for the report; vertex refinement apart, normals not counted.
/// `sampleSeconds` covers samples and vertices, `polygonizeSeconds` the triangles.
struct Counts {
    uint64_t pointEvaluations = 0;
    uint64_t intervalEvaluations = 0;
    uint64_t refinementEvaluations = 0;
    uint64_t surfaceCells = 0;
    double subdivideSeconds = 0, sampleSeconds = 0, polygonizeSeconds = 0;
    SumOfTimes field;  ///< of sampleSeconds, what the field's evaluation takes; with PolygonizeOptions::timeField
    Counts& operator+=(const Counts& o);
};

/// Which regions to look at, cubes of `blocks` blocks along an edge. Called from any thread.
struct RegionFilter {
    /// Asked before anything is known of at most 64 regions: bit i leaves region i out with all below. None where
    /// empty.
    std::function<uint64_t(std::span<const Vec3i> indices, int blocks)> skips;
    /// Asked of a region that may hold surface, with the tape shortened to it: false leaves it out likewise.
    std::function<bool(Vec3i index, int blocks, const eval::Tape& tape)> wants;
};

/// Blocks that may hold surface, ordered by (z, y, x), but for those that `filter` leaves out. Error::Cancelled when
/// `progress` says so, Error::Input for a box without end and for cells that aren't positive or that float32 can't
/// resolve at the grid's place, Error::Budget for more than 2¹⁵ cells along an axis. `scratch`: memory to be used again
/// from call to call.
Result<std::vector<Block>> subdivide(const eval::Tape& tape, const Grid& grid, int threads, Progress* progress,
                                     Counts& counts, const RegionFilter& filter = {},
                                     std::vector<eval::Workspace>* scratch = nullptr);

}  // namespace sgm::mesh
