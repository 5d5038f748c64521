// Which parts of a tape changed with its numbers, each as a tape of its own.
// Enters: a tape, and which of its constants changed. Leaves: those operands of its topmost minima that read one, with
// the numbers of before and of now. Assumes the code stayed. Where such a part is farther from the surface than anyone
// cares, before and now, `shorten` makes of the whole tape what it made before (see `Reach`).
#pragma once

#include <vector>

#include "modeler/eval/incremental_compiler.h"
#include "modeler/eval/tape_builder.h"
#include "modeler/eval/use_def_chains.h"

namespace sgm::eval {

class Workspace;

class ChangedParts {
public:
    /// Looks for the parts. False where they are so much of the tape that to ask them costs more than it saves. What is
    /// known of the code is kept: use a new object for other code.
    bool find(const Tape& tape, const NumbersChanged& changed);
    /// What is known of the parts in boxes, at most 64, before and now.
    struct Reach {
        /// Bit i is set where every part stays above care.most in box i. There minima take nothing from a part, nor
        /// does it narrow what they pass down: its greatest value is above all they care for. So the whole tape,
        /// shortened to the box, is the same as with the old numbers.
        uint64_t unreached;
        bool bounded;  ///< in all others the parts' values are numbers, of which ranges tell something
    };
    Reach reach(std::span<const Box3f> boxes, RelevantRange relevant, Workspace& workspace) const;
    /// `tape`, the one of the last `find`, shortened to a box whatever numbers the parts come to have there.
    Tape around(const Tape& tape, const Box3f& box, RelevantRange relevant, Workspace& workspace) const;

private:
    struct Part {
        Tape before, now;
    };
    void mark(const Tape& tape, const NumbersChanged& changed);
    void descend(const Tape& tape);
    void extract(const Tape& tape, uint32_t value, Tape& into);

    UseDefChains chains_;
    TapeBuilder builder_;
    std::vector<uint8_t> numbers_,
        values_;  ///< by place in the table, and by value as in UseDefChains: does it hang on a change?
    std::vector<uint32_t> found_, stack_;  ///< changed values below the topmost minima
    std::vector<Part> parts_;              ///< the first found_.size() of them
};

}  // namespace sgm::eval
