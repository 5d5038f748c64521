// Cells of a block whose surface lies in one plane along the axes, as fans of fewer triangles.
// Enters: marching cubes of a block with labels. Leaves: the cells that are left, and the fans. The surface is the same
// to the bit: fans use vertices of these cells, and all of those that other triangles share.
#pragma once

#include <span>
#include <vector>

#include "modeler/mesh/block_surface.h"

namespace sgm::mesh {

/// One worker's, reused from block to block.
class FlatCells {
public:
    /// Takes cells out of `cells` and `triangles`, and the origins of these out of `origins`: rectangles of cells that
    /// have one label and lie in one plane across an axis become fans around a vertex inside them. A rectangle of w by
    /// h cells has 2 (w + h) triangles instead of 2 w h; its other vertices inside are left without triangles. The
    /// lists are those that `surface` shows. O(cells).
    void takeOut(const BlockSurface& surface, PageVector<SurfaceCell>& cells, size_t& count,
                 PageVector<Triangle>& triangles, PageVector<OriginId>& origins);
    /// The fans in place of what was taken out; corners as in the surface.
    const std::vector<Triangle>& fans() const { return fans_; }

private:
    struct Cell {
        uint32_t cell;   ///< of the surface
        uint32_t first;  ///< place of the vertex on the edge at its low corner
        int axis;        ///< across its plane
    };
    /// Cells along the two axes of a plane.
    struct Rectangle {
        Vec3i low, u, v;
        int across, up;
    };

    bool isFlat(const Cell& cell, Vec3i low) const;
    const Cell* cellAt(Vec3i low) const;
    bool isContinued(const Cell& by, Vec3i low) const;
    Rectangle largestFrom(const Cell& cell) const;
    void addFan(const Cell& cell, const Rectangle& cells);
    void listFlat();
    void makeFans();

    const BlockSurface* surface_ = nullptr;
    std::vector<Cell> flat_;
    std::vector<uint32_t> flatAt_ = std::vector<uint32_t>(cornersPerBlock);  ///< by low corner: 1 + place in flat_
    std::vector<bool> isTaken_;                                              ///< by cell of the surface
    std::vector<Triangle> fans_;
};

}  // namespace sgm::mesh
