// An expensive field's values at a block's corners: every second one first, then those that the surface may be near to.
// Enters: a block, the bricks to look at. Leaves: the field's values at both ends of every edge that the surface cuts,
// and elsewhere numbers of the right sign. Assumes that the field's Lipschitz constant is one: from a sample that is
// far from 0 it follows that the surface cuts no edge around (sphere tracing's argument, Hart 1996, for a grid).
#pragma once

#include "modeler/core/pages.h"
#include "modeler/mesh/coarse_loops.h"
#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {

/// Coordinates of a block's corners along each axis, metres.
using CornerCoordinates = std::array<std::array<float, blockCorners + rowPadding>, 3>;

/// One worker's, reused from block to block.
class CoarseSamples {
public:
    /// Evaluates every second corner of bricks. Returns those of them in which the field may have both signs.
    uint64_t enter(const Block& block, uint64_t bricks, const CornerCoordinates& coordinates, float cell_m,
                   eval::Workspace& workspace, Counts& counts);
    /// Writes some of `active` such bricks to the block's `values`, up to its corner `last`, by a tape that is good for
    /// all of them. The bricks before them have to be there.
    void sample(uint64_t bricks, uint64_t active, const eval::Tape& tape, const CornerCoordinates& coordinates,
                Vec3i last, float* values, eval::Workspace& workspace, Counts& counts);

private:
    static constexpr int along = blockCells / 2 + 1, row = along, layer = along * along;
    static constexpr int corner(Vec3i brick) {
        return (brick.x + along * (brick.y + along * brick.z)) * (coarseCorners - 1);
    }
    static constexpr size_t enough = brickCorners * brickCorners * brickCorners;  ///< points at a time
    static constexpr size_t most = 2 * enough;                                    ///< with another brick's

    size_t ask(const eval::Tape& tape, uint64_t bricks, eval::Workspace& workspace);

    PageVector<float> values_ = PageVector<float>(along * along * along + rowPadding);
    std::array<std::array<float, along + rowPadding>, 3> coordinates_{};
    std::array<Between, bricksPerBlock> between_;
    PointRows<most> points_;
    alignas(64) std::array<float, most + rowPadding> f_;
};

}  // namespace sgm::mesh
