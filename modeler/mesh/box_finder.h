// Which of some boxes meet another one.
// Enters: boxes of about one size. Leaves: their places in the list. A grid of cells as large as the boxes on average,
// by hash; most questions end at a bit that isn't set.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The box around the corners of a triangle, metres.
inline Box3f boxOf(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3f a = positions[t.x], b = positions[t.y], c = positions[t.z];
    return {min(min(a, b), c), max(max(a, b), c)};
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
    /// Calls visit(t, found) for the triangles t in [begin, end) whose boxes meet some, in their order; `found` as
    /// find() gives it, cornersOf(t) numbers in `positions`. Triangles that follow each other are asked for together
    /// first, as those of a mesh lie beside each other.
    template <class CornersOf, class Visit>
    void visitMeeting(std::span<const Vec3f> positions, size_t begin, size_t end, CornersOf&& cornersOf,
                      Visit&& visit) const;
    /// False where no box meets `box`, by a coarse grid: O(1) where `box` is about as large as they are.
    bool mayMeet(const Box3f& box) const {
        Cells cells;
        return cellsOf(box, cells) && isCoarseMarked(cells);
    }
    /// The boxes that meet `box`, ascending. O(1) as a rule where none is near and `box` is about as large as they are.
    void find(const Box3f& box, std::vector<uint32_t>& found) const {
        found.clear();
        Cells cells;
        if (cellsOf(box, cells) && isCoarseMarked(cells)) findIn(cells, box, found);
    }

private:
    static constexpr size_t askedTogether = 8;
    struct Entry {
        uint64_t cell;
        uint32_t box;
    };
    /// Cells that a box meets.
    struct Cells {
        Vec3i first, last;
    };
    static uint64_t numberOf(Vec3i cell) {
        return static_cast<uint64_t>(cell.z) << 42 | static_cast<uint64_t>(cell.y) << 21 |
               static_cast<uint64_t>(cell.x);
    }
    /// Those of a box; false where it is beside all boxes.
    bool cellsOf(const Box3f& box, Cells& cells) const {
        const Vec3f lo = (max(box.lo, around_.lo) - around_.lo) * cellsPerMetre_,
                    hi = (min(box.hi, around_.hi) - around_.lo) * cellsPerMetre_;
        if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)) return false;  // also where there are no boxes
        cells = {{static_cast<int>(lo.x), static_cast<int>(lo.y), static_cast<int>(lo.z)},
                 {static_cast<int>(hi.x), static_cast<int>(hi.y), static_cast<int>(hi.z)}};
        return true;
    }
    Vec3i coarse(Vec3i cell) const { return {cell.x >> coarseBits_, cell.y >> coarseBits_, cell.z >> coarseBits_}; }
    size_t rowOf(int y, int z) const { return (static_cast<size_t>(z) * rows_ + static_cast<size_t>(y)) * rowWords_; }
    /// Whether one of the coarse cells around some cells has entries.
    bool isCoarseMarked(const Cells& cells) const {
        const Vec3i first = coarse(cells.first), last = coarse(cells.last);
        const size_t begin = static_cast<size_t>(first.x) / 64, end = static_cast<size_t>(last.x) / 64;
        const uint64_t head = ~uint64_t{0} << first.x % 64, tail = ~uint64_t{0} >> (63 - last.x % 64);
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y) {
                const uint64_t* const row = coarseMarks_.data() + rowOf(y, z);
                for (size_t w = begin; w <= end; ++w)
                    if (row[w] & (w == begin ? head : ~uint64_t{0}) & (w == end ? tail : ~uint64_t{0})) return true;
            }
        return false;
    }
    void findIn(const Cells& cells, const Box3f& box, std::vector<uint32_t>& found) const;
    std::vector<Entry> listEntries();
    void order(std::span<const Entry> entries);

    std::span<const Box3f> boxes_;
    Box3f around_;
    float cellsPerMetre_ = 0;
    int coarseBits_ = 0;                 ///< as many as two to the power of this cells along an axis make a coarse one
    size_t rows_ = 0, rowWords_ = 0;     ///< of the coarse cells: rows along x in a layer, words a row
    std::vector<uint64_t> coarseMarks_;  ///< a bit a coarse cell, set where it has entries
    int bucketBits_ = 0;
    std::vector<uint32_t> bucketBegin_;  ///< by hash of a cell and one more: its first entry
    std::vector<Entry> entries_;         ///< by bucket
};

template <class CornersOf, class Visit>
void BoxFinder::visitMeeting(std::span<const Vec3f> positions, size_t begin, size_t end, CornersOf&& cornersOf,
                             Visit&& visit) const {
    std::array<Box3f, askedTogether> boxes;
    std::vector<uint32_t> found;
    for (size_t first = begin; first < end; first += askedTogether) {
        const size_t count = std::min(askedTogether, end - first);
        Box3f all;
        for (size_t i = 0; i < count; ++i) {
            boxes[i] = boxOf(positions, cornersOf(first + i));
            all = {min(all.lo, boxes[i].lo), max(all.hi, boxes[i].hi)};
        }
        if (!mayMeet(all)) continue;
        for (size_t i = 0; i < count; ++i) {
            find(boxes[i], found);
            if (!found.empty()) visit(first + i, std::span<const uint32_t>(found));
        }
    }
}

}  // namespace sgm::mesh
