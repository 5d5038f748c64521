// Owners ride forward beside the values: each instruction passes on the owner of the operand it takes.
// Enters: a tape's instructions and register rows, block by block. Leaves: whose surface each point lies on. Assumes
// blocks of at most maxBlock points, and operands that are still in their registers.
#pragma once

#include <array>
#include <vector>

#include "modeler/eval/blocks.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

class OwnerPass {
public:
    /// `planes` floats a value in the registers; the rows in `scratch` are kept from call to call.
    OwnerPass(const Tape& tape, size_t planes, std::vector<OriginId>& scratch);

    /// To be called before each instruction runs.
    void operator()(const Instruction& in, const StepContext& c);

    /// Owners of the tape's value at the first n points of the block.
    void store(OriginId* out, size_t n) const;

private:
    /// Owners of a register or an operand over a block.
    struct Owners {
        const OriginId* row = nullptr;  ///< null where all points have the same
        OriginId one = 0;               ///< then that one; 0 is nobody
        OriginId at(size_t i) const { return row ? row[i] : one; }
    };
    struct Operand {
        const float* values;  ///< null for a constant
        float constant;
        Owners owners;
    };
    OriginId* rowOf(uint32_t reg) { return rows_.data() + reg * maxBlock; }
    const float* valuesOf(const Operand& o, size_t n);
    void gather(const Instruction& in, const field::OpTraits& row, const StepContext& c);
    bool alike(uint32_t first, uint32_t last) const;
    void take(const field::OpTraits& row, size_t n);
    template <class Beats>
    void takeBest(uint32_t first, size_t n, Beats beats);

    const Tape& tape_;
    const size_t planes_;
    std::vector<OriginId>& rows_;  // by register, then one for the instruction at work
    std::vector<Owners> owners_;   // by register; x, y, z belong to nobody
    std::vector<Operand> operands_;
    std::array<float, maxBlock> constant_, best_;
    OriginId* taken_;
};

}  // namespace sgm::eval
