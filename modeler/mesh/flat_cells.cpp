#include "modeler/mesh/flat_cells.h"

namespace sgm::mesh {
namespace {

/// Which corners of a cell are at the low end of each axis.
constexpr uint16_t lowCorners[] = {0x55, 0x33, 0x0f};

/// The axis that a cell's surface lies across, where all corners at one end of it are inside and no other is; -1 else.
int axisAcross(uint16_t inside) {
    for (int axis = 0; axis < 3; ++axis)
        if (inside == lowCorners[axis] || inside == (lowCorners[axis] ^ 0xff)) return axis;
    return -1;
}

}  // namespace

/// Whether the vertices of a cell have one label, and one place along the axis, bit by bit.
bool FlatCells::isFlat(const Cell& cell, Vec3i low) const {
    const Vec3i u = stepAlong((cell.axis + 1) % 3), v = stepAlong((cell.axis + 2) % 3);
    for (const Vec3i at : {low + u, low + v, low + u + v}) {
        const uint32_t place = surface_->placeOf(surface_->vertexAt(at, cell.axis));
        if (surface_->labels[place] != surface_->labels[cell.first] ||
            surface_->positions[place][cell.axis] != surface_->positions[cell.first][cell.axis])
            return false;
    }
    return true;
}

/// The flat cell at a corner, or null.
const FlatCells::Cell* FlatCells::cellAt(Vec3i low) const {
    if (maxComponent(low) >= blockCells) return nullptr;
    const uint32_t number = flatAt_[static_cast<size_t>(cornerNumber(low.x, low.y, low.z))];
    return number == 0 ? nullptr : &flat_[number - 1];
}

/// Whether there is a flat cell at a corner that continues another one's plane and piece, and that no fan has yet.
bool FlatCells::isContinued(const Cell& by, Vec3i low) const {
    const Cell* const next = cellAt(low);
    return next && !isTaken_[next->cell] && surface_->cells[next->cell].inside == surface_->cells[by.cell].inside &&
           surface_->labels[next->first] == surface_->labels[by.first] &&
           surface_->positions[next->first][by.axis] == surface_->positions[by.first][by.axis];
}

/// As far as it reaches along one axis of the plane, and then as far as such rows do along the other.
FlatCells::Rectangle FlatCells::largestFrom(const Cell& cell) const {
    Rectangle cells{cornerIndices(surface_->cells[cell.cell].corner), stepAlong((cell.axis + 1) % 3),
                    stepAlong((cell.axis + 2) % 3), 1, 1};
    while (isContinued(cell, cells.low + cells.u * cells.across)) ++cells.across;
    const auto hasRow = [&](int row) {
        for (int i = 0; i < cells.across; ++i)
            if (!isContinued(cell, cells.low + cells.u * i + cells.v * row)) return false;
        return true;
    };
    while (hasRow(cells.up)) ++cells.up;
    return cells;
}

void FlatCells::addFan(const Cell& cell, const Rectangle& cells) {
    const auto at = [&](int i, int j) { return surface_->vertexAt(cells.low + cells.u * i + cells.v * j, cell.axis); };
    const uint32_t middle = at(cells.across / 2, cells.up / 2);
    const bool facesUp = surface_->cells[cell.cell].inside == lowCorners[cell.axis];
    const auto add = [&](uint32_t a, uint32_t b) {  // counter-clockwise seen from the axis' high end
        fans_.push_back(facesUp ? Triangle{middle, a, b} : Triangle{middle, b, a});
    };
    for (int i = 0; i < cells.across; ++i) add(at(i, 0), at(i + 1, 0)), add(at(i + 1, cells.up), at(i, cells.up));
    for (int j = 0; j < cells.up; ++j) add(at(cells.across, j), at(cells.across, j + 1)), add(at(0, j + 1), at(0, j));
}

void FlatCells::listFlat() {
    flat_.clear();
    for (uint32_t c = 0; c < surface_->cells.size(); ++c) {
        const SurfaceCell& at = surface_->cells[c];
        const int axis = axisAcross(at.inside);
        if (axis < 0) continue;
        const Vec3i low = cornerIndices(at.corner);
        const Cell cell{c, surface_->placeOf(surface_->vertexAt(low, axis)), axis};
        if (!isFlat(cell, low)) continue;
        flat_.push_back(cell);
        flatAt_[at.corner] = static_cast<uint32_t>(flat_.size());
    }
}

void FlatCells::makeFans() {
    fans_.clear();
    isTaken_.assign(surface_->cells.size(), false);
    for (const Cell& cell : flat_) {
        if (isTaken_[cell.cell]) continue;
        const Rectangle cells = largestFrom(cell);
        if (cells.across * cells.up <= cells.across + cells.up) continue;
        addFan(cell, cells);
        for (int j = 0; j < cells.up; ++j)
            for (int i = 0; i < cells.across; ++i) isTaken_[cellAt(cells.low + cells.u * i + cells.v * j)->cell] = true;
    }
    for (const Cell& cell : flat_) flatAt_[surface_->cells[cell.cell].corner] = 0;
}

void FlatCells::takeOut(const BlockSurface& surface, PageVector<SurfaceCell>& cells, size_t& count,
                        PageVector<Triangle>& triangles, PageVector<OriginId>& origins) {
    surface_ = &surface;
    listFlat();
    makeFans();
    if (fans_.empty()) return;
    size_t keptCells = 0, keptTriangles = 0, triangle = 0;
    for (size_t c = 0; c < count; ++c) {
        const size_t end = triangle + caseTable()[cells[c].inside].triangles;
        if (!isTaken_[c]) {
            cells[keptCells++] = cells[c];
            for (size_t t = triangle; t < end; ++t, ++keptTriangles)
                triangles[keptTriangles] = triangles[t], origins[keptTriangles] = origins[t];
        }
        triangle = end;
    }
    count = keptCells;
    triangles.resize(keptTriangles), origins.resize(keptTriangles);
}

}  // namespace sgm::mesh
