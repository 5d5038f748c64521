// Cubes of cells on the way down, and whether they can hold surface.
// Enters: a cube's index and edge, the grid. Leaves: cells, box, verdict. Assumes ranges that enclose the field.
#pragma once

#include <array>
#include <cmath>
#include <tuple>

#include "modeler/core/result.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

inline constexpr int maxCellsPerAxis = 1 << 15;

/// The order of blocks: by z, then y, then x.
inline bool zyxLess(Vec3i a, Vec3i b) { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); }

/// Cells [lo, hi) of the grid.
struct CellRange {
    Vec3i lo, hi;
    bool empty() const { return lo.x >= hi.x || lo.y >= hi.y || lo.z >= hi.z; }
};

/// The cells of cube `index` of edge `edgeCells`, cut off at the grid's end.
inline CellRange cellsOf(Vec3i index, int edgeCells, const Grid& grid) {
    const Vec3i lo = index * edgeCells;
    return {lo, min(lo + Vec3i{edgeCells, edgeCells, edgeCells}, grid.cells)};
}

/// Holds every corner of the cells, bit by bit: `Grid::corner` rounds monotonically.
inline Box3f boxOf(const CellRange& cells, const Grid& grid) {
    return {grid.corner(cells.lo.x, cells.lo.y, cells.lo.z), grid.corner(cells.hi.x, cells.hi.y, cells.hi.z)};
}

/// Blocks along an edge of the cube that the descent begins with.
inline int blocksOfRoot(const Grid& grid) {
    int size = regionSplits;
    while (size * blockCells < maxComponent(grid.cells)) size *= regionSplits;
    return size;
}

/// Parts of a region that have cells, in order: of all, those along z from `firstLayer` to `endLayer`.
struct Children {
    std::array<Vec3i, regionSplits * regionSplits * regionSplits> indices;
    std::array<CellRange, regionSplits * regionSplits * regionSplits> cells;
    std::array<Box3f, regionSplits * regionSplits * regionSplits> boxes;
    size_t n = 0;

    Children(Vec3i region, int childCells, int firstLayer, int endLayer, const Grid& grid) {
        for (int k = firstLayer; k < endLayer; ++k)
            for (int j = 0; j < regionSplits; ++j)
                for (int i = 0; i < regionSplits; ++i) {
                    const Vec3i index = region * regionSplits + Vec3i{i, j, k};
                    const CellRange range = cellsOf(index, childCells, grid);
                    if (range.empty()) continue;
                    indices[n] = index;
                    cells[n] = range;
                    boxes[n++] = boxOf(range, grid);
                }
    }
    void leaveOut(uint64_t which) {
        size_t left = 0;
        for (size_t i = 0; i < n; ++i) {
            if (which >> i & 1) continue;
            indices[left] = indices[i], cells[left] = cells[i], boxes[left] = boxes[i];
            ++left;
        }
        n = left;
    }
};

/// False when all samples of the cells count alike. Samples on the grid's border count as outside whatever the field
/// says (so the mesh closes even where bounds were wrong), hence a region that is inside all over ends where it touches
/// the border.
inline bool mayHoldSurface(eval::FloatInterval range, bool touchesBorder) {
    return range.lo < 0 && (touchesBorder || !(range.hi < 0));
}
inline bool mayHoldSurface(eval::FloatInterval range, const CellRange& cells, const Grid& grid) {
    return mayHoldSurface(range, minComponent(cells.lo) == 0 || minComponent(grid.cells - cells.hi) == 0);
}

/// Whether an evaluation costs as much as dozens of others, and no shortening spares it: the tape folds a fractal.
bool isExpensive(const eval::Tape& tape);

/// Distances, in cells, within which a sample of an expensive field tells the signs: those of a corner's neighbours, so
/// that the surface cuts no edge there, of corners 1, √2 or √3 away. A little more is for rounding.
inline constexpr float farEdge = 2.0625f, farFace = 2.48f, farMiddle = 2.8f;

/// What the mesher tells apart of the field's values. On an edge that the surface cuts they stay within Lipschitz
/// constant · cell of 0, and vertices lie on those edges; of all other values only the sign counts. The constant is
/// rounded up to a power of two, so that small changes of it change nothing, and a quarter more is for rounding.
/// Samples of an expensive field are also asked how far the surface is.
eval::RelevantRange relevantRangeFor(const eval::Tape& tape, const Grid& grid);

/// Values of a block's tape up to this one, by amount, have the bits of the whole field's, whatever the block: a little
/// less than `relevantRangeFor` tells apart of a field that isn't expensive.
float surfaceReach(const eval::Tape& tape, const Grid& grid);

/// Metres: the least cells that float32 can resolve so far from the origin, metres.
constexpr float leastCellAt(float distance_m) { return distance_m * 0x1.0p-13f; }

/// Error::Input for a box without end and for cells that float32 can't resolve or that aren't positive, Error::Budget
/// for too many along an axis.
Status checkGrid(const Grid& grid);

}  // namespace sgm::mesh
