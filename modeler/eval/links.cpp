#include "modeler/eval/links.h"

namespace sgm::eval {

void Links::follow(const Tape& tape) {
    code_ = tape.code().data();
    boundRows_ = 0;
    values_.clear();
    first_.resize(tape.size());
    bounds_.resize(tape.size());
    holder_.resize(tape.registerCount());  // the value each register holds
    for (uint32_t axis = 0; axis < 3; ++axis) holder_[axis] = axis;
    const auto valueOf = [&](Source s) { return isConstant(s) ? s : holder_[s]; };
    for (size_t i = 0; i < tape.size(); ++i) {
        const Instruction& in = tape.code()[i];
        const field::OpTraits& row = field::traits(in.op);
        first_[i] = static_cast<uint32_t>(values_.size());
        bounds_[i] = boundRows_;
        if (row.arity == field::ops::variadic) {
            for (uint32_t k = in.a; k < in.a + in.count; ++k) values_.push_back(valueOf(tape.sources()[k]));
        } else {
            values_.push_back(valueOf(in.a));
            if (in.count > 1) values_.push_back(valueOf(in.b));
        }
        if (row.chooses) boundRows_ += in.count + 1;
        if (needsRange(in)) boundRows_ += 2;
        holder_[in.out] = static_cast<uint32_t>(i) + 3;
    }
    result_ = valueOf(tape.result());
}

}  // namespace sgm::eval
