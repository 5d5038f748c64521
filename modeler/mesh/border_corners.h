// Corners where a border between two looks meets a crease: the planes around them leave open where along the crease.
// Enters: corners of a block's cells. Leaves: those moved along their creases to where the border ends. Assumes corners
// that lie on their pieces' planes already.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "modeler/mesh/piece_samples.h"

namespace sgm::mesh {

/// A point in a cell where three pieces or more meet.
struct CellCorner {
    static constexpr float reach = 8;  ///< of a cell, that it may lie outside its cell

    Vec3i cell;
    size_t brick;
    uint32_t loop;
    Vec3f at;               ///< inside the cell
    Vec3f meeting;          ///< of its planes: `at`, or outside the cell
    bool settled = false;   ///< looking again would move it no more
    bool isSmooth = false;  ///< no piece bends where it meets the next: planes don't tell where that is
    bool leaves = false;    ///< the pieces were found around a meeting outside the cell
    std::vector<PiecePoint> planes;
    std::vector<uint32_t> labels;
    std::vector<Vec3f> means;  ///< by label: the middle of its nodes
};

/// One worker's search, reused from block to block.
class BorderCorners {
public:
    /// Moves corners of which two neighbouring pieces lie in one plane and end at one crease, which lies in the cell,
    /// to where the one goes over to the other; they aren't settled then. Returns how often the field was evaluated.
    uint64_t place(std::span<CellCorner> corners, const BlockTapes& tapes, const Grid& grid,
                   eval::Workspace& workspace);

private:
    struct OnCrease {
        CellCorner* corner;
        Vec3f from;                    ///< where the corner was
        Vec3f along, beside;           ///< the crease's unit direction, and the way to where the pieces are looked at
        std::array<size_t, 2> pieces;  ///< in the corner's labels
        std::array<float, 2> span;     ///< of the crease, from there, in which the border ends
        Vec3f at(float share) const { return from + along * (span[0] + (span[1] - span[0]) * share); }
    };
    static std::optional<OnCrease> creaseOf(CellCorner& corner, const Grid& grid);
    bool narrow(OnCrease& crease, size_t sample) const;

    PieceSamples probes_;
};

}  // namespace sgm::mesh
