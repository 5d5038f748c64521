// Owners ride forward beside the values: each instruction passes on the owner of the operand it takes.
#include "modeler/eval/blocks.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

/// One operand over a block: its values and owners, or a constant's.
struct Owned {
    const float* values;      ///< null for a constant
    const OriginId* owners;   ///< null for a constant
    float constant;
    OriginId origin;          ///< the operand's own owner; 0 lets those of its value through

    float value(size_t i) const { return values ? values[i] : constant; }
    OriginId owner(size_t i) const { return origin != 0 || !owners ? origin : owners[i]; }
};

/// Which operand an instruction takes at point i.
size_t taken(field::ops::Owner rule, uint32_t firstChoice, const std::vector<Owned>& operands, size_t i) {
    using field::ops::Owner;
    size_t best = firstChoice;
    switch (rule) {
        case Owner::Least:
            for (size_t k = best + 1; k < operands.size(); ++k)
                if (operands[k].value(i) < operands[best].value(i)) best = k;
            break;
        case Owner::Greatest:
            for (size_t k = best + 1; k < operands.size(); ++k)
                if (operands[k].value(i) > operands[best].value(i)) best = k;
            break;
        case Owner::Nearer: best = operands[2].value(i) > 0.5f ? 1 : 0; break;
        case Owner::First:
            for (best = 0; best + 1 < operands.size() && operands[best].owner(i) == 0;) ++best;
            break;
    }
    return best;
}

class OriginPass {
public:
    OriginPass(const Tape& tape, Workspace::Impl& w) : tape_(tape), registers_(w.origins) {}

    void operator()(const Instruction& in, const StepContext& c) {
        const field::OpTraits& row = field::traits(in.op);
        operands_.clear();
        const Source direct[] = {in.a, in.b};
        const Source* const sources = row.arity == field::ops::variadic ? c.sources + in.a : direct;
        for (uint32_t k = 0; k < in.count; ++k) {
            const OriginId origin = in.origins ? tape_.origins()[in.origins - 1 + k] : 0;
            operands_.push_back(operand(sources[k], origin, c));
        }
        OriginId* const out = owners(in.out, c);
        for (size_t i = 0; i < c.count; ++i)
            out[i] = operands_[taken(row.owner, row.firstChoice, operands_, i)].owner(i);
    }
    /// Makes room for the registers of a block; those of x, y, z belong to nobody.
    void begin(size_t stride) {
        registers_.resize(std::max(registers_.size(), tape_.registerCount() * stride));
        std::fill_n(registers_.begin(), 3 * stride, OriginId{0});
    }
    OriginId* owners(uint32_t reg, const StepContext& c) { return registers_.data() + reg * c.stride; }

private:
    Owned operand(Source s, OriginId origin, const StepContext& c) {
        if (isConstant(s)) return {nullptr, nullptr, c.constants[indexOf(s)], origin};
        return {c.registers + s * c.stride, owners(s, c), 0.0f, origin};
    }

    const Tape& tape_;
    std::vector<OriginId>& registers_;
    std::vector<Owned> operands_;
};

}  // namespace

void evaluateOrigin(const Tape& tape, Points points, OriginId* out, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    OriginPass pass(tape, w);
    pass.begin(maxBlock);
    runBlocks(tape, points, w.kernels.values, 1, w, [&](const Instruction& in, const StepContext& c) { pass(in, c); },
              [&](const StepContext& c, size_t first, size_t n) {
                  for (size_t i = 0; i < n; ++i) {
                      OriginId id = tape.origins()[0];
                      if (id == 0 && !isConstant(tape.result())) id = pass.owners(tape.result(), c)[i];
                      out[first + i] = id;
                  }
              });
}

}  // namespace sgm::eval
