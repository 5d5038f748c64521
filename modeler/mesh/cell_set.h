// Some of a grid's cells.
// Enters: cells by their low corners. Leaves: which are in a set, and what is told of each.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/number_set.h"
#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

/// Cells of a grid, in the order in which they came.
class CellSet {
public:
    /// Whether the cell was not there; its indices are at least −2 and less than 2²⁰. Amortised O(1).
    bool insert(Vec3i cell) {
        const bool isNew = numbers_.insert(numberOf(cell));
        if (isNew) list_.push_back(cell), box_ = {min(box_.lo, cell), max(box_.hi, cell)};
        return isNew;
    }
    bool contains(Vec3i cell) const { return box_.contains(cell) && numbers_.contains(numberOf(cell)); }
    const std::vector<Vec3i>& list() const { return list_; }
    bool empty() const { return list_.empty(); }
    size_t size() const { return list_.size(); }

    /// Differs for different cells, in its low bits too.
    static uint64_t numberOf(Vec3i cell) {
        const auto bits = [](int c) { return static_cast<uint64_t>(static_cast<uint32_t>(c + 2)); };
        const uint64_t h = (bits(cell.x) << 42 | bits(cell.y) << 21 | bits(cell.z) | 1ull << 63) * 0x9e3779b97f4a7c15u;
        return h ^ h >> 29;
    }

private:
    NumberSet numbers_;
    std::vector<Vec3i> list_;
    Box3<int32_t> box_;
};

/// A number for each of some cells.
class CellNumbers {
public:
    static constexpr uint32_t none = 0xffffffffu;

    /// The cell's number, to be read and written until the next call; `none` at first. Amortised O(1).
    uint32_t& operator[](Vec3i cell) {
        if (2 * (count_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[placeOf(CellSet::numberOf(cell))];
        if (slot.cell == 0) slot.cell = CellSet::numberOf(cell), ++count_;
        return slot.number;
    }
    uint32_t find(Vec3i cell) const { return slots_[placeOf(CellSet::numberOf(cell))].number; }

private:
    struct Slot {
        uint64_t cell = 0;  ///< 0: free
        uint32_t number = none;
    };
    size_t placeOf(uint64_t cell) const {
        size_t at = cell & (slots_.size() - 1);
        while (slots_[at].cell != 0 && slots_[at].cell != cell) at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow();

    std::vector<Slot> slots_ = std::vector<Slot>(1024);
    size_t count_ = 0;
};

/// Calls `visit` with a cell and its 26 neighbours, whether the grid has them or not.
template <class Visit>
void visitAround(Vec3i cell, Visit&& visit) {
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) visit(cell + Vec3i{x, y, z});
}

/// Those of the components of `cells` to which none of `others` belongs or is next, edges and corners included. O(n).
CellSet componentsWithout(const CellSet& cells, const CellSet& others);

/// Whether the grid has the cell.
inline bool isInGrid(const Grid& grid, Vec3i cell) {
    return minComponent(cell) >= 0 && minComponent(grid.cells - cell) > 0;
}

/// The cell of a grid that holds a point of its box; its sides belong to the higher one.
Vec3i cellAt(const Grid& grid, Vec3d p);

/// The cell that a triangle lies in.
inline Vec3i cellOf(const Grid& grid, std::span<const Vec3f> positions, const Triangle& t) {
    return cellAt(grid,
                  (positions[t.x].as<double>() + positions[t.y].as<double>() + positions[t.z].as<double>()) / 3.0);
}

}  // namespace sgm::mesh
