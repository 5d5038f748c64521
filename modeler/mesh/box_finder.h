// Which of some boxes meet another one.
// Enters: boxes of about one size. Leaves: their places in the list. A grid of cells as large as the boxes on average,
// by hash; most questions end at a bit that isn't set.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The box around the corners of a triangle, metres.
inline Box3f boxOf(std::span<const Vec3f> positions, const Triangle& t) {
    return hull(hull(Box3f{positions[t.x], positions[t.x]}, positions[t.y]), positions[t.z]);
}

/// The cube that reaches so many metres from its middle.
inline Box3f cubeAround(Vec3f middle, double reach_m) {
    return Box3f{middle, middle}.inflated(static_cast<float>(reach_m));
}

/// An index over boxes that don't change.
class BoxFinder {
public:
    /// O(n) in the boxes, which have to stay.
    explicit BoxFinder(std::span<const Box3f> boxes);
    /// The boxes that meet `box`, ascending. O(1) as a rule where none is near and `box` is about as large as they are.
    void find(const Box3f& box, std::vector<uint32_t>& found) const {
        found.clear();
        Cells cells;
        if (cellsOf(box, cells) && isMarked(cells.coarse())) findIn(cells, box, found);
    }

private:
    struct Entry {
        uint64_t cell;
        uint32_t box;
        friend bool operator<(const Entry& a, const Entry& b) {
            return a.cell != b.cell ? a.cell < b.cell : a.box < b.box;
        }
    };
    static constexpr int coarseBits = 2;
    /// Cells that a box meets.
    struct Cells {
        Vec3i first, last;
        /// As many as two to the power of `coarseBits` cells along an axis make one.
        Cells coarse() const {
            const auto of = [](Vec3i cell) {
                return Vec3i{cell.x >> coarseBits, cell.y >> coarseBits, cell.z >> coarseBits};
            };
            return {of(first), of(last)};
        }
        /// Calls `visit` with the number of each until it returns true; whether one did.
        template <class Visit>
        bool any(Visit&& visit) const;
    };
    static uint64_t numberOf(Vec3i cell) {
        return static_cast<uint64_t>(cell.z) << 42 | static_cast<uint64_t>(cell.y) << 21 |
               static_cast<uint64_t>(cell.x);
    }
    /// Those of a box; false where it is beside all boxes.
    bool cellsOf(const Box3f& box, Cells& cells) const {
        const Vec3f lo = (max(box.lo, around_.lo) - around_.lo) * cellsPerMetre_,
                    hi = (min(box.hi, around_.hi) - around_.lo) * cellsPerMetre_;
        if (hi.x < lo.x || hi.y < lo.y || hi.z < lo.z) return false;
        cells = {{static_cast<int>(lo.x), static_cast<int>(lo.y), static_cast<int>(lo.z)},
                 {static_cast<int>(hi.x), static_cast<int>(hi.y), static_cast<int>(hi.z)}};
        return true;
    }
    /// Whether one of some coarse cells has entries, or seems to.
    bool isMarked(const Cells& coarse) const {
        if (coarse.first == coarse.last) return coarseMarks_.has(numberOf(coarse.first));
        return isOneMarked(coarse);
    }
    bool isOneMarked(const Cells& coarse) const;
    void findIn(const Cells& cells, const Box3f& box, std::vector<uint32_t>& found) const;

    /// A bit for each hash of a cell.
    class Marks {
    public:
        void set(uint64_t cell) { words_[placeOf(cell) / 64] |= uint64_t{1} << placeOf(cell) % 64; }
        bool has(uint64_t cell) const { return words_[placeOf(cell) / 64] >> placeOf(cell) % 64 & 1; }

    private:
        static constexpr int bits = 20;
        static size_t placeOf(uint64_t cell) { return static_cast<size_t>(cell * 0x9e3779b97f4a7c15u >> (64 - bits)); }
        std::vector<uint64_t> words_ = std::vector<uint64_t>((size_t{1} << bits) / 64);
    };

    std::span<const Box3f> boxes_;
    Box3f around_;
    float cellsPerMetre_ = 0;
    std::vector<Entry> entries_;  ///< ascending
    Marks marks_, coarseMarks_;   ///< of cells that have entries
};

}  // namespace sgm::mesh
