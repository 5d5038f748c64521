// Owners ride forward beside the values: each instruction passes on the owner of the operand it takes.
// Enters: a tape's instructions and register rows, block by block. Leaves: whose surface each point lies on. Assumes
// blocks of at most maxBlock points, one float a value, and operands that are still in their registers.
#pragma once

#include <array>
#include <bit>

#include "modeler/eval/blocks.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

class OwnerPass {
public:
    OwnerPass(const Tape& tape, Workspace::Impl& workspace);

    /// To be called before each instruction runs.
    void operator()(const Instruction& in, const StepContext& c);

    /// Owners of the tape's value at the first n points of the block.
    void store(OriginId* out, size_t n) const;

private:
    float* rowOf(uint32_t reg) { return rows_ + reg * maxBlock; }
    const float* valuesOf(const OwnedOperand& o, size_t n);
    void gather(const Instruction& in, const Source* sources, const StepContext& c);
    bool alike(uint32_t first, uint32_t last) const;
    const float* onlyRow() const;
    bool takeOfTwo(const field::OpTraits& row, size_t n, float* taken) const;
    void take(const field::OpTraits& row, size_t n);
    void takeBest(uint32_t first, size_t n, ArgMinUpdate move);

    const Tape& tape_;
    const Kernels& kernels_;
    float* const rows_;            // by register
    float* const taken_;           // of the instruction at work
    std::vector<Owners>& owners_;  // by register; x, y, z belong to nobody
    std::vector<OwnedOperand>& operands_;
    alignas(vectorFloats * sizeof(float)) std::array<float, maxBlock> constant_, best_;
};

}  // namespace sgm::eval
