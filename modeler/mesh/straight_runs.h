// Runs of cells along straight creases and borders, as strips of fewer triangles.
// Enters: the cells of a block whose vertices lie on several pieces. Leaves: the runs among them, and strips between
// the breaks at both ends of each. Assumes vertices with labels that blocks around an edge agree on, bit by bit.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/mesh/block_surface.h"
#include "modeler/mesh/cell_pieces.h"

namespace sgm::mesh {

/// A cell whose vertices lie on several pieces.
struct MixedCell {
    uint32_t cell, firstTriangle, endTriangle;  ///< of the surface
    int joined = 0;                             ///< see loopsOf
    bool isInRun = false;                       ///< filled by a strip, not by itself
};

/// Cells along an axis between two others, all alike: their vertices are the same across the axis, bit by bit.
struct StraightRun {
    Vec3i low;  ///< corner of the first cell
    int axis = 0;
    int cells = 0;
    std::array<int, 2> edges;  ///< of a cell, at its low end: those that the piece before the break cuts, and after it
    uint32_t firstMember = 0;  ///< in the list of all runs
};

/// The end of a run: the break in the face there, and its vertex.
struct RunEnd {
    const Break* at;
    uint32_t vertex;
};

/// One worker's, reused from block to block.
class StraightRuns {
public:
    /// Looks for runs of four cells or more with two pieces, and marks those between the first and last one of each in
    /// `mixed`. O(cells).
    void find(const BlockSurface& surface, std::vector<MixedCell>& mixed);
    const std::vector<StraightRun>& all() const { return runs_; }
    /// Whether the breaks at the ends of a run are one straight crease or border between its two pieces.
    bool isStraight(const StraightRun& run, const std::array<const Break*, 2>& ends) const;
    /// Leaves out the runs that keep(number) is false for: their cells are no longer marked. Whether there were any.
    template <class Keep>
    bool leaveOut(std::vector<MixedCell>& mixed, Keep&& keep) {
        size_t kept = 0;
        for (size_t r = 0; r < runs_.size(); ++r) {
            if (keep(r))
                runs_[kept++] = runs_[r];
            else
                for (int k = 0; k < runs_[r].cells; ++k)
                    mixed[members_[runs_[r].firstMember + static_cast<uint32_t>(k)]].isInRun = false;
        }
        const bool left = kept < runs_.size();
        runs_.resize(kept);
        return left;
    }
    /// Adds a strip a piece from the run's vertices to the breaks at its ends.
    void fill(const StraightRun& run, const std::array<RunEnd, 2>& ends, PieceTriangles& out) const;

private:
    /// How a cell continues along an axis; -1 where it doesn't.
    struct Way {
        int axis = -1;
        std::array<int, 2> edges{};
    };

    uint32_t placeAt(Vec3i low, int edge) const;
    Way wayThrough(const SurfaceCell& cell) const;
    uint32_t neighbourOf(const std::vector<MixedCell>& mixed, uint32_t of, Vec3i low) const;
    void addRun(std::vector<MixedCell>& mixed, uint32_t first);
    uint32_t vertexOf(const StraightRun& run, size_t piece, int k) const;

    const BlockSurface* surface_ = nullptr;
    std::vector<Way> ways_;                                                   ///< by mixed cell
    std::vector<uint32_t> mixedAt_ = std::vector<uint32_t>(cornersPerBlock);  ///< by low corner: 1 + its place
    std::vector<StraightRun> runs_;
    std::vector<uint32_t> members_;  ///< mixed cells, run by run
};

}  // namespace sgm::mesh
