// Where a surface is cut along the sides of cells, and how the same surface in finer cells meets the cut.
// Enters: surfaces with their triangles by cell. Leaves: for every edge of the coarse cut the vertices of the fine one.
// Assumes that triangles lie in their cells, and edges between two cells on the side that these share, bit by bit: so
// it is in a crisp mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Which triangles of a surface lie in which cell of a grid. They are sorted by cubes of cells, and by cells when one
/// of a cube is asked for: few are, of a large surface.
class SurfaceInCells {
public:
    /// Both have to stay; the surface may get more triangles behind those that it has, see `follow`.
    SurfaceInCells(const Chunk& surface, const Grid& grid) : surface_(surface), grid_(grid) {}
    /// Looks at triangles that are new. O(n) in them.
    void follow();

    const Chunk& surface() const { return surface_; }
    Vec3i cellOf(uint32_t triangle) const {
        return mesh::cellOf(grid_, surface_.positions, surface_.triangles[triangle]);
    }
    bool isEmpty(Vec3i cell) {
        sortCubeOf(cell);
        return lastOfCell_.find(cell) == CellNumbers::none;
    }
    /// Calls `visit` with the triangles in a cell, the last one first.
    template <class Visit>
    void visit(Vec3i cell, Visit&& visit) {
        sortCubeOf(cell);
        for (uint32_t t = lastOfCell_.find(cell); t != CellNumbers::none; t = before_[t]) visit(t);
    }

private:
    Vec3i cubeOf(uint32_t triangle) const;
    void sortCubeOf(Vec3i cell);

    const Chunk& surface_;
    const Grid& grid_;
    PageVector<uint32_t> before_;  ///< by triangle: the one before it in its cell, or in its cube until it is sorted
    CellNumbers lastOfCell_;       ///< of the cells' triangles
    CellNumbers lastOfCube_;       ///< of the cubes' triangles that aren't sorted by cells
};

/// The side of a cell.
struct CellSide {
    Vec3i cell;
    int axis = 0;         ///< of its normal
    bool isHigh = false;  ///< the side towards higher coordinates

    /// The cell on the other side.
    Vec3i beyond() const {
        Vec3i other = cell;
        other[axis] += isHigh ? 1 : -1;
        return other;
    }
};

/// Calls `visit` with the six sides of a cell.
template <class Visit>
void visitSides(Vec3i cell, Visit&& visit) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool isHigh : {false, true}) visit(CellSide{cell, axis, isHigh});
}

/// How a coarse surface beyond a side fits a fine one before it.
struct SeamFit {
    /// Fine vertices between the ends of a coarse triangle's edge.
    struct Edge {
        uint32_t triangle, from, to;  ///< coarse, in the triangle's sense
        std::vector<uint32_t> inner;  ///< fine, from `from` on
    };
    struct Pair {
        uint32_t coarse, fine;
    };
    std::vector<Pair> vertices;  ///< those that are one
    std::vector<Edge> edges;
};

/// Fits the coarse triangles beyond a side to the fine ones before it, which are in the side's cell. Nothing where one
/// of the cuts has no vertex for one of the other, or runs another way: then the coarse cells don't show what the fine
/// ones do. O(k²) in the edges on the side.
std::optional<SeamFit> fitSeam(const CellSide& side, const Grid& grid, SurfaceInCells& coarse, SurfaceInCells& fine);

}  // namespace sgm::mesh
