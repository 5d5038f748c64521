// Which of some boxes meet another one.
// Enters: boxes of about one size. Leaves: their places in the list. A grid of cells as large as the boxes on average,
// by hash; most questions end at a bit that isn't set.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// An index over boxes that don't change.
class BoxFinder {
public:
    /// O(n) in the boxes, which have to stay.
    explicit BoxFinder(std::span<const Box3f> boxes);
    /// The boxes that meet `box`, ascending. O(1) as a rule where none is near and `box` is about as large as they are.
    void find(const Box3f& box, std::vector<uint32_t>& found) const;

private:
    struct Entry {
        uint64_t cell;
        uint32_t box;
        friend bool operator<(const Entry& a, const Entry& b) {
            return a.cell != b.cell ? a.cell < b.cell : a.box < b.box;
        }
    };
    /// Calls `visit` with the number of each cell that a box meets.
    template <class Visit>
    void forCells(const Box3f& box, Visit&& visit) const;
    static size_t bitOf(uint64_t cell) { return static_cast<size_t>(cell * 0x9e3779b97f4a7c15u >> (64 - bits)); }

    static constexpr int bits = 20;
    std::span<const Box3f> boxes_;
    Box3f around_;
    float cellsPerMetre_ = 0;
    std::vector<Entry> entries_;   ///< ascending
    std::vector<uint64_t> marks_;  ///< a bit for each hash of a cell that has entries
};

}  // namespace sgm::mesh
