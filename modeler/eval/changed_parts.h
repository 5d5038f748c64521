// Which parts of a tape changed with its numbers, each as a tape of its own.
// Enters: a tape, and which of its constants changed. Leaves: those operands of its topmost minima that read one, with the
// numbers of before and of now. Assumes the code stayed. Where such a part is farther from the surface than anyone cares,
// before and now, `shorten` makes of the whole tape what it made before (see `unreached`).
#pragma once

#include <optional>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "modeler/eval/recompiler.h"

namespace sgm::eval {

struct ChangedPart {
    Tape before, now;
};

/// Nothing where the parts are so much of the tape that to ask them costs more than it saves.
std::optional<std::vector<ChangedPart>> changedParts(const Tape& tape, const NumbersChanged& changed);

/// Bit i is set where every part stays above care.most in box i (at most 64). There minima take nothing from a part, nor
/// does it narrow what they pass down: its greatest value is above all they care for. So the whole tape, shortened to the
/// box, is the same as with the old numbers.
uint64_t unreached(const std::vector<ChangedPart>& parts, std::span<const Box3f> boxes, Care care, Workspace& workspace);

}  // namespace sgm::eval
