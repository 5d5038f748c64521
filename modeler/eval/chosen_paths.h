// The pieces of long tapes at few points: a point's value is that of one operand of each minimum and maximum on its
// way, so most instructions have no say in it.
// Enters: a tape, at most 64 points. Leaves: the operands that the points take, then values, derivatives and names by
// these alone, bit for bit those of all instructions. Assumes that ops treat points apart from each other.
#pragma once

#include "modeler/eval/blocks.h"
#include "modeler/eval/labels.h"

namespace sgm::eval {

/// Points at once, a bit each.
inline constexpr size_t pathPoints = 64;

/// One worker's pass over points of a tape.
class ChosenPaths {
public:
    /// `planes`: 1 for values with their names, 4 for derivatives as well, by `steps`.
    ChosenPaths(const Tape& tape, Workspace::Impl& workspace, size_t planes, const Step* steps);

    /// Runs the tape at n ≤ pathPoints points. Afterwards values are in the context's registers, and `names` has their
    /// names. Costs a value of all instructions, and what was asked for of those that the points take.
    const StepContext& run(Points points);
    const LabelPass& names() const { return names_; }

private:
    void findChoices(Points points);
    void findLive(size_t n);
    void runLive(size_t n);
    Choice choiceOf(const Instruction& in);
    uint64_t derivativesOfSecond(const Instruction& in, const Choice& choice) const;
    void takeValues(const Instruction& in, const Choice& choice) const;

    const Tape& tape_;
    Workspace::Impl& w_;
    const size_t planes_;
    const Step* const steps_;
    LabelPass names_;
    StepContext values_, live_;
};

}  // namespace sgm::eval
