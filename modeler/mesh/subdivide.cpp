#include "modeler/mesh/subdivide.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/region.h"

namespace sgm::mesh {
namespace {

constexpr int splits = regionSplits;
/// A level of the descent with fewer instructions is sooner gone through than a thread comes; a region by itself costs
/// as much as some of them.
constexpr size_t worthAThread = 500, instructionsARegion = 20;

/// A cube of blocks on the way down: blocks [index · size, (index + 1) · size) of its level.
using Region = Block;

/// Splits one region into those children that may hold surface and that the filter wants, each with its tape shortened
/// to it. Part `part` of `parts`, layers of children.
std::vector<Region> split(const eval::Tape& tape, Vec3i index, int part, int parts, int childCells, const Grid& grid,
                          const RegionFilter& filter, eval::Workspace& workspace, Counts& counts) {
    const int blocks = childCells / blockCells;
    Children children(index, childCells, splits * part / parts, splits * (part + 1) / parts, grid);
    if (filter.skips) children.leaveOut(filter.skips({children.indices.data(), children.n}, blocks));
    if (children.n == 0) return {};
    std::array<eval::FloatInterval, splits * splits * splits> ranges;
    const eval::RangeTrace trace =
        eval::evaluateRanges(tape, {children.boxes.data(), children.n}, ranges.data(), workspace);
    counts.intervalEvaluations += children.n;

    std::vector<Region> kept;
    for (size_t c = 0; c < children.n; ++c) {
        if (!mayHoldSurface(ranges[c], children.cells[c], grid)) continue;
        Region child{children.indices[c], eval::shorten(tape, trace, c, workspace, relevantRangeFor(tape, grid))};
        if (!filter.wants || filter.wants(child.index, blocks, child.tape)) kept.push_back(std::move(child));
    }
    return kept;
}

/// Blocks by (z, y, x); each is moved once.
void inOrder(std::vector<Block>& blocks) {
    std::vector<uint32_t> order(blocks.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return zyxLess(blocks[a].index, blocks[b].index); });
    std::vector<Block> ordered;
    ordered.reserve(blocks.size());
    for (const uint32_t b : order) ordered.push_back(std::move(blocks[b]));
    blocks = std::move(ordered);
}

}  // namespace

Counts& Counts::operator+=(const Counts& o) {
    pointEvaluations += o.pointEvaluations;
    intervalEvaluations += o.intervalEvaluations;
    refinementEvaluations += o.refinementEvaluations;
    surfaceCells += o.surfaceCells;
    subdivideSeconds += o.subdivideSeconds;
    sampleSeconds += o.sampleSeconds;
    polygonizeSeconds += o.polygonizeSeconds;
    field += o.field;
    return *this;
}

float cellFor(const Box3f& bounds, int resolution) {
    const float longest = bounds.empty() ? 0.0f : maxComponent(bounds.size());
    return longest > 0 ? longest / static_cast<float>(std::max(1, resolution)) : 1.0f;
}

Grid gridFor(const Box3f& bounds, float cell_m) {
    if (bounds.empty() || !(cell_m > 0) || !std::isfinite(cell_m)) return {{}, cell_m, {}};
    constexpr float nowhere = std::numeric_limits<float>::quiet_NaN();
    if (!bounds.finite()) return {{nowhere, nowhere, nowhere}, cell_m, {}};
    Grid grid{{}, cell_m, {}};
    for (int axis = 0; axis < 3; ++axis) {
        // Centred, with 1¼ to 1¾ cells around: bounds, where flat faces like to be, never pass through samples.
        const double size = static_cast<double>(bounds.hi[axis]) - bounds.lo[axis];
        const double cells = std::round(size / cell_m) + 3;
        grid.cells[axis] = static_cast<int>(std::min(cells, static_cast<double>(maxCellsPerAxis)));
        grid.origin[axis] = static_cast<float>(bounds.lo[axis] - (cells * cell_m - size) / 2);
    }
    return grid;
}

Status checkGrid(const Grid& grid) {
    if (!(grid.cell_m > 0) || !std::isfinite(grid.cell_m))
        return Error{Error::Kind::Input, "the cell size must be a positive number of metres"};
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(grid.origin[axis]))
            return Error{Error::Kind::Input, "the box to fill with cells has no end: cut the object to a finite one"};
        if (grid.cells[axis] >= maxCellsPerAxis)
            return Error{Error::Kind::Budget, "the grid would have more than " + std::to_string(maxCellsPerAxis) +
                                                  " cells along one axis: choose larger cells"};
        const float last = grid.origin[axis] + grid.cell_m * static_cast<float>(grid.cells[axis]);
        const float farthest = std::max(std::abs(grid.origin[axis]), std::abs(last));
        // Vertices keep 1/1024 of a cell from its corners, which float32 has to be able to say.
        if (const float least = leastCellAt(farthest); !(grid.cell_m >= least))
            return Error{Error::Kind::Input,
                         fmt::format("cells of {:.3g} m are too small for single precision {:.4g} m from the origin: "
                                     "take cells of {:.2g} m or more, or move the model nearer to the origin",
                                     grid.cell_m, farthest, 1.05f * least)};
    }
    return Done{};
}

Result<std::vector<Block>> subdivide(const eval::Tape& tape, const Grid& grid, int threads, Progress* progress,
                                     Counts& counts, const RegionFilter& filter,
                                     std::vector<eval::Workspace>* scratch) {
    const auto start = std::chrono::steady_clock::now();
    if (Status status = checkGrid(grid); !status) return status.error();
    int size = blocksOfRoot(grid);
    std::vector<eval::Workspace> own;
    std::vector<eval::Workspace>& workspaces = scratch ? *scratch : own;
    workspaces.resize(std::max(workspaces.size(), static_cast<size_t>(threadCount(threads))));
    std::vector<Region> regions;
    const bool any = minComponent(grid.cells) > 0;
    for (bool whole = any; any && size > 1; size /= splits, whole = false) {
        size_t work = whole ? tape.size() : 0;
        for (const Region& region : regions) work += instructionsARegion + region.tape.size();
        const int wanted = work >= worthAThread ? threads : 1;
        const int parts = whole ? std::min(threadCount(wanted), splits) : 1;
        const size_t tasks = whole ? static_cast<size_t>(parts) : regions.size();
        if (progress) progress->begin("subdivide", tasks);
        std::vector<std::vector<Region>> children(tasks);
        std::vector<Counts> counted(workspaces.size());
        parallelFor(tasks, wanted, progress, [&](size_t i, int worker) {
            const int childCells = size / splits * blockCells;
            children[i] = whole ? split(tape, {0, 0, 0}, static_cast<int>(i), parts, childCells, grid, filter,
                                        workspaces[worker], counted[worker])
                                : split(regions[i].tape, regions[i].index, 0, 1, childCells, grid, filter,
                                        workspaces[worker], counted[worker]);
            tick(progress);
        });
        if (cancelled(progress)) return cancelledError();
        regions.clear();
        for (std::vector<Region>& some : children) std::move(some.begin(), some.end(), std::back_inserter(regions));
        for (const Counts& c : counted) counts += c;
    }
    inOrder(regions);
    counts.subdivideSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return regions;
}

}  // namespace sgm::mesh
