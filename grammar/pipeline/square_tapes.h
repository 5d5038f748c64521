// The model's tape over squares of the plan, each shortened from that of the square around it.
// Enters: a tape, cells. Leaves: tapes with what matters there alone, so that a cell of a large city costs what stands
// in it and not what stands in the city. Assumes cells in an order in which neighbours come close to each other; any
// other order takes longer and gives the same tapes.
#pragma once

#include <optional>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "modeler/eval/region_cuts.h"
#include "modeler/tiles/cell.h"

namespace sgm::pipeline {

class SquareTapes {
public:
    /// How far around a square its tape holds: for one of level 0, doubled from level to level so many times.
    struct Margins {
        double finest_m;
        int doublings;  ///< also the coarsest level that is asked for
    };
    /// The tape of the whole model, which has to stay, and the box it is asked in; `finest_m` is the side of cells of
    /// level 0.
    SquareTapes(const eval::Tape& whole, const Box3f& bounds, double finest_m, const Margins& margins);

    /// Finds out which parts of the whole tape matter where, in passes over all of it; the first call of `over` does it
    /// otherwise. Nothing for an empty box, in which `over` has no meaning.
    void cutWhole();
    /// The tape for a square and its margin around it, also above and below the box: the values, owners and labels
    /// there are those of the whole one. Valid until the next call. Squares that follow others in the same larger one
    /// cost little more than the tapes that they get. A long tape is cut to 64 squares at once, so that what is held
    /// besides the tapes of a few squares grows with the whole one's parts by 20 bytes each.
    const eval::Tape& over(const tiles::Cell& square, eval::Workspace& workspace);

private:
    /// Squares of one level, [x, x + along) × [z, z + across), with the cuts of a tape to them.
    struct Cuts {
        int level, x, z, along, across;
        eval::RegionCuts cuts;
        bool has(const tiles::Cell& square) const;
    };
    struct Step {
        tiles::Cell square;
        eval::Tape tape;
        std::optional<eval::RangeTrace> trace;  ///< of the tape over the square's quarters, once it was asked for
        std::optional<Cuts> cuts;               ///< likewise, of a long tape
    };
    Step first(const tiles::Cell& square, eval::Workspace& workspace);
    Step below(Step& around, const tiles::Cell& square, eval::Workspace& workspace) const;
    eval::Tape quarterOf(Step& around, const tiles::Cell& quarter, eval::Workspace& workspace) const;
    Cuts cutsOf(const eval::Tape& tape, const tiles::Cell& from, const tiles::Cell& to) const;
    eval::Tape cut(const eval::Tape& tape, const Cuts& cuts, const tiles::Cell& square,
                   eval::Workspace& workspace) const;
    Box3f boxOf(const tiles::Cell& square) const;

    const eval::Tape& whole_;
    const Box3f bounds_;
    const double finest_m_;
    const Margins margins_;
    std::optional<Cuts> ofWhole_;
    std::vector<Step> path_;  ///< from the coarsest square down to the last one asked for
};

}  // namespace sgm::pipeline
