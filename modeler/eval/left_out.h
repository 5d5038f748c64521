// What shortening would leave out, asked before it is done.
// Enters: a tape, the trace of evaluateRanges. Leaves: regions. Assumes as `shorten` does.
#pragma once

#include <cstdint>

#include "modeler/eval/evaluate.h"

namespace sgm::eval {

/// Bit i is set where `shorten` to region i may leave out an instruction, given by its number. Exact where one min or
/// max at the end of the tape decides on it; where others choose too, all bits are set. Of the first `n` regions
/// of a trace, which must be of this very tape.
uint64_t mayLeaveOut(const Tape& tape, size_t instruction, size_t n, const RangeTrace& trace,
                     RelevantRange relevant = {});

}  // namespace sgm::eval
