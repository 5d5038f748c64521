#include "modeler/eval/use_def_chains.h"

#include <algorithm>

namespace sgm::eval {
namespace {

Pruning pruningOf(const field::OpTraits& row, bool leaf) {
    if (row.selects) return Pruning::Selects;
    if (row.chooses) return Pruning::Chooses;
    return leaf ? Pruning::Leaf : Pruning::NeedsAll;
}

}  // namespace

void UseDefChains::build(const Tape& tape) {
    code_ = tape.code().data();
    boundRows_ = 0;
    values_.clear();
    chains_.resize(tape.size());
    holder_.resize(tape.registerCount());  // the value each register holds
    for (uint32_t axis = 0; axis < 3; ++axis) holder_[axis] = axis;
    readers_.assign(tape.size() + 3, 0);
    const auto valueOf = [&](Source s) { return isConstant(s) ? s : holder_[s]; };
    const auto read = [&](Source s) {
        const Source value = valueOf(s);
        if (!isConstant(value)) ++readers_[value];
        values_.push_back(value);
    };
    for (size_t i = 0; i < tape.size(); ++i) {
        const Instruction& in = tape.code()[i];
        const field::OpTraits& row = field::traits(in.op);
        const auto first = static_cast<uint32_t>(values_.size());
        if (row.arity == field::ops::variadic) {
            for (uint32_t k = in.a; k < in.a + in.count; ++k) read(tape.sources()[k]);
        } else {
            read(in.a);
            if (in.count > 1) read(in.b);
        }
        const bool leaf =
            std::all_of(values_.begin() + first, values_.end(), [](Source s) { return isConstant(s) || s < 3; });
        chains_[i] = {first, boundRows_, pruningOf(row, leaf)};
        if (row.chooses) boundRows_ += in.count + 1;
        if (needsRange(in)) boundRows_ += 2;
        holder_[in.out] = static_cast<uint32_t>(i) + 3;
    }
    result_ = valueOf(tape.result());
}

}  // namespace sgm::eval
