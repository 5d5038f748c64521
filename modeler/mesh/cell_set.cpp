#include "modeler/mesh/cell_set.h"

namespace sgm::mesh {

void CellNumbers::grow() {
    std::vector<Slot> old(4 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
        if (slot.cell != 0) slots_[placeOf(slot.cell)] = slot;
}

CellSet componentsWithout(const CellSet& cells, const CellSet& others) {
    CellSet leftOut;
    std::vector<Vec3i> open;
    const auto enter = [&](Vec3i cell) {
        if (cells.contains(cell) && leftOut.insert(cell)) open.push_back(cell);
    };
    for (const Vec3i cell : others.list()) visitAround(cell, enter);
    while (!open.empty()) {
        const Vec3i cell = open.back();
        open.pop_back();
        visitAround(cell, enter);
    }
    CellSet kept;
    for (const Vec3i cell : cells.list())
        if (!leftOut.contains(cell)) kept.insert(cell);
    return kept;
}

Vec3i cellAt(const Grid& grid, Vec3d p) {
    Vec3i cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = grid.origin[axis], size = grid.cell_m;
        int& i = cell[axis] = static_cast<int>((p[axis] - origin) / size);
        const auto corner = [&](int at) {
            return static_cast<double>(grid.corner(at, at, at)[axis]);  // as it is rounded
        };
        while (i > 0 && p[axis] < corner(i)) --i;
        while (i + 1 < grid.cells[axis] && !(p[axis] < corner(i + 1))) ++i;
    }
    return cell;
}

}  // namespace sgm::mesh
