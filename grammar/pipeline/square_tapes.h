// The model's tape over squares of the plan, each shortened from that of the square around it.
// Enters: a tape, cells. Leaves: tapes with what matters there alone, so that a cell of a large city costs what stands
// in it and not what stands in the city. Assumes cells in an order in which neighbours come close to each other; any
// other order takes longer and gives the same tapes.
#pragma once

#include <optional>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "modeler/tiles/cell.h"

namespace sgm::pipeline {

class SquareTapes {
public:
    /// The tape of the whole model, which has to stay, and the box it is asked in; `finest_m` is the side of cells of
    /// level 0.
    SquareTapes(const eval::Tape& whole, const Box3f& bounds, double finest_m)
        : whole_(whole), bounds_(bounds), finest_m_(finest_m) {}

    /// The tape for a square and so much around it, also above and below the box: the values, owners and labels there
    /// are those of the whole one. Valid until the next call. Squares of one side and margin, in Morton order, cost
    /// little more than the tapes that they get.
    const eval::Tape& over(const tiles::Cell& square, double margin_m, eval::Workspace& workspace);

private:
    struct Step {
        tiles::Cell square;
        eval::Tape tape;
        std::optional<eval::RangeTrace> trace;  ///< of the tape over the square's quarters, once it was asked for
    };
    eval::Tape quarterOf(Step& around, const tiles::Cell& quarter, eval::Workspace& workspace) const;
    Box3f boxOf(const tiles::Cell& square) const;

    const eval::Tape& whole_;
    const Box3f bounds_;
    const double finest_m_;
    double margin_m_ = 0;     ///< of the path
    std::vector<Step> path_;  ///< from the coarsest square down to the last one asked for
};

}  // namespace sgm::pipeline
