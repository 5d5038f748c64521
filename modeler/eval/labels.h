// Names of smooth pieces of surface ride forward beside the values: each instruction passes on the name of the operand
// it takes, or makes one of its own where it folds or has faces.
// Enters: a tape's instructions and register rows, block by block. Leaves: for each point the label of the piece and
// its origin. Assumes blocks of at most maxBlock points and operands that are still in their registers. A label is a
// hash of Instruction::piece and of choices, so that dropping operands that cannot be taken changes none. Where the two
// operands of a maximum are each other's negative, as below a cut that ends at the foot of what it cuts, no solid is
// left: the place is pinched, and of two operands of a minimum that tie one that isn't is taken.
#pragma once

#include <array>
#include <vector>

#include "modeler/eval/blocks.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

class LabelPass {
public:
    /// `planes`: floats of a value in the register file, 1 for values and 4 for gradients.
    LabelPass(const Tape& tape, Workspace::Impl& workspace, size_t planes);

    /// To be called before each instruction runs.
    void operator()(const Instruction& in, const StepContext& c);

    /// The same for a minimum or maximum whose operands' names the points take by `choice`. Of operands that no point
    /// takes the names aren't read.
    void choose(const Instruction& in, const StepContext& c, const Choice& choice);

    /// Labels and origins of the tape's value at the first n points of the block.
    void store(uint32_t* labels, OriginId* origins, size_t n) const;

private:
    /// One operand: its values, null for a constant, and its names.
    struct Operand {
        const float* values;
        float constant;
        PieceNames names;
        float at(size_t i) const { return values ? values[i] : constant; }
    };

    Operand operand(const Instruction& in, const Source* sources, uint32_t k, const StepContext& c) const;
    bool isUnnamed(const Instruction& in, const Source* sources) const;
    void choose(const Instruction& in, const Source* sources, const StepContext& c, bool least);
    Names pinched(const Operand& a, const Operand& b, const Names& known, size_t n, uint32_t* to) const;
    Names taken(const Names& first, const Names& second, const uint32_t* takesSecond, size_t n, uint32_t* to);
    void blend(const Instruction& in, const Source* sources, const StepContext& c);
    void nameFaces(const Instruction& in, const Source* sources, const StepContext& c);
    void nameSides(const Instruction& in, const Source* sources, const StepContext& c);
    void morph(const Instruction& in, const Source* sources, const StepContext& c);
    Names combined(const Instruction& in, const Source* sources, const StepContext& c);
    Names firstOrigin(const Instruction& in, const Source* sources, const StepContext& c);
    Names ofPiece(const Instruction& in, Names label, size_t n);
    static Names copied(const Names& names, size_t n, uint32_t* to);
    static Names settled(uint32_t* row, size_t n);

    uint32_t* labelRow(uint32_t reg) { return rows_ + 3 * reg * maxBlock; }
    uint32_t* originRow(uint32_t reg) { return labelRow(reg) + maxBlock; }
    uint32_t* pinchedRow(uint32_t reg) { return labelRow(reg) + 2 * maxBlock; }

    const Tape& tape_;
    const size_t planes_;
    uint32_t* rows_;                              // by register
    std::vector<PieceNames>& names_;              // by register
    std::array<uint32_t, maxBlock> takesSecond_;  // of the instruction in work, by point: all bits or none
};

}  // namespace sgm::eval
