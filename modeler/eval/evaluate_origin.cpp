// Owners ride forward beside the values: each instruction passes on the owner of the operand it takes.
#include "modeler/eval/blocks.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

using field::ops::Owner;

/// One operand over a block: its values and owners, or a constant's.
struct Owned {
    const float* values;     ///< null for a constant
    const OriginId* owners;  ///< null where nobody owns any of it
    float constant;
    OriginId origin;  ///< the operand's own owner; 0 lets those of its value through

    float value(size_t i) const { return values ? values[i] : constant; }
    OriginId owner(size_t i) const { return origin != 0 || !owners ? origin : owners[i]; }
    bool nobody() const { return origin == 0 && !owners; }
};

/// The operand from `first` on that no later one beats; ties go to the first.
template <class Beats>
size_t best(const std::vector<Owned>& operands, size_t first, size_t i, Beats beats) {
    size_t at = first;
    for (size_t k = first + 1; k < operands.size(); ++k)
        if (beats(operands[k].value(i), operands[at].value(i))) at = k;
    return at;
}

/// Which operand an instruction takes at point i.
size_t taken(const field::OpTraits& row, const std::vector<Owned>& operands, size_t i) {
    switch (row.owner) {
        case Owner::Least:
            return best(operands, row.firstChoice, i, [](float a, float b) { return a < b; });
        case Owner::Greatest:
            return best(operands, row.firstChoice, i, [](float a, float b) { return a > b; });
        case Owner::Nearer:
            return operands[2].value(i) > 0.5f ? 1 : 0;
        case Owner::First:
            break;
    }
    size_t k = 0;
    while (k + 1 < operands.size() && operands[k].owner(i) == 0) ++k;
    return k;
}

class OriginPass {
public:
    OriginPass(const Tape& tape, std::vector<OriginId>& registers)
        : tape_(tape), registers_(registers), owned_(tape.registerCount()) {
        registers_.resize(std::max(registers_.size(), tape.registerCount() * maxBlock));
    }

    void operator()(const Instruction& in, const StepContext& c) {
        const field::OpTraits& row = field::traits(in.op);
        const Source direct[] = {in.a, in.b};
        const Source* const sources = row.arity == field::ops::variadic ? c.sources + in.a : direct;
        operands_.clear();
        bool nobody = true;
        for (uint32_t k = 0; k < in.count; ++k) {
            operands_.push_back(operand(sources[k], in.origins ? tape_.origins()[in.origins - 1 + k] : 0, c));
            nobody = nobody && operands_.back().nobody();
        }
        owned_[in.out] = !nobody;
        if (nobody) return;  // most of a tape: the arithmetic below the first union
        OriginId* const out = rowOf(in.out);
        for (size_t i = 0; i < c.count; ++i) out[i] = operands_[taken(row, operands_, i)].owner(i);
    }

    /// The owner of the tape's value at point i of the block.
    OriginId result(size_t i) const {
        const OriginId own = tape_.origins()[0];
        if (own != 0 || isConstant(tape_.result()) || !owned_[tape_.result()]) return own;
        return registers_[tape_.result() * maxBlock + i];
    }

private:
    OriginId* rowOf(uint32_t reg) { return registers_.data() + reg * maxBlock; }
    Owned operand(Source s, OriginId origin, const StepContext& c) {
        if (isConstant(s)) return {nullptr, nullptr, c.constants[indexOf(s)], origin};
        return {c.registers + s * c.stride, owned_[s] ? rowOf(s) : nullptr, 0.0f, origin};
    }

    const Tape& tape_;
    std::vector<OriginId>& registers_;
    std::vector<bool> owned_;  // by register; x, y, z belong to nobody
    std::vector<Owned> operands_;
};

}  // namespace

void evaluateOrigin(const Tape& tape, Points points, OriginId* out, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    OriginPass pass(tape, w.origins);
    runBlocks(
        tape, points, w.kernels.values, 1, w, [&](const Instruction& in, const StepContext& c) { pass(in, c); },
        [&](const StepContext&, size_t first, size_t n) {
            for (size_t i = 0; i < n; ++i) out[first + i] = pass.result(i);
        });
}

}  // namespace sgm::eval
