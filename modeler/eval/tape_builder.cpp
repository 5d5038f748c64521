#include "modeler/eval/tape_builder.h"

#include <algorithm>
#include <array>

#include "modeler/field/ops.h"

namespace sgm::eval {

void TapeBuilder::reserve(size_t keys, size_t instructions) {
    code_.reserve(instructions);
    clearAhead(std::array{unusedOf(code_)});
    values_.resize(keys, Value{});
    liveBits_.resize(keys / 64 + 1);
}

void TapeBuilder::begin(size_t keys, size_t instructions) {
    if (values_.size() < keys) {
        values_.resize(keys, Value{});
        liveBits_.resize(keys / 64 + 1);
    }
    if (code_.size() < instructions) code_.resize(instructions);
    first_ = code_.size();
    free_.clear();
    sources_.clear();
    origins_.assign(1, 0);  // entry 0 is the owner of the result
    registers_ = 3;
    longest_ = 0;
}

/// Makes room for more instructions before those that are written: what is left of a tape is often far less than it.
void TapeBuilder::grow() {
    LargePageVector<Instruction> larger(std::max<size_t>(256, 2 * code_.size()));
    first_ = larger.size() - code_.size();
    std::copy(code_.begin(), code_.end(), larger.begin() + static_cast<ptrdiff_t>(first_));
    code_ = std::move(larger);
}

void TapeBuilder::bindInput(uint32_t key, uint32_t coordinate) {
    values_[key].reg = coordinate;
    inputs_.push_back(key);
}

void TapeBuilder::result(Use use) {
    origins_[0] = use.origin;
    result_ = demand(use, 0);
}

void TapeBuilder::define(uint32_t key, const Instruction& like, const Use* operands, size_t count, bool listed) {
    Instruction& in = begun(key, like, count, listed);
    if (listed)
        for (size_t i = 0; i < count; ++i) origins_.push_back(operands[i].origin);
    const auto entry = [&](size_t i) { return listed ? in.origins - 1 + static_cast<uint32_t>(i) : none; };
    if (field::traits(like.op).arity == field::ops::variadic) {
        for (size_t i = 0; i < count; ++i) sources_.push_back(demand(operands[i], entry(i)));
    } else {
        in.a = demand(operands[0], entry(0));
        if (count > 1) in.b = demand(operands[1], entry(1));
    }
}

void TapeBuilder::define(uint32_t key, const Instruction& like, const Source* operands, const OriginId* origins) {
    Instruction& in = begun(key, like, like.count, origins != nullptr);
    if (origins) origins_.insert(origins_.end(), origins, origins + in.count);
    const auto source = [&](uint32_t i) {
        return demand({operands[i], origins ? origins[i] : 0}, origins ? in.origins - 1 + i : none);
    };
    if (field::traits(in.op).arity == field::ops::variadic) {
        sources_.insert(sources_.end(), operands, operands + in.count);
        Source* const own = sources_.data() + in.a;
        for (uint32_t i = 0; i < in.count; ++i)
            if (!isConstant(operands[i])) own[i] = source(i);
    } else {
        in.a = source(0);
        if (in.count > 1) in.b = source(1);
    }
}

void TapeBuilder::defineLeaf(uint32_t key, const Instruction& like, const Source* operands, const OriginId* origins) {
    Instruction& in = begun(key, like, like.count, origins != nullptr);
    if (origins) origins_.insert(origins_.end(), origins, origins + in.count);
    if (field::traits(in.op).arity == field::ops::variadic) {
        sources_.insert(sources_.end(), operands, operands + in.count);
    } else {
        in.a = operands[0];
        if (in.count > 1) in.b = operands[1];
    }
}

void TapeBuilder::finish(const std::shared_ptr<const std::vector<float>>& constants,
                         const std::shared_ptr<const Grids>& grids, Scale scale, Tape& into) {
    for (const uint32_t key : inputs_) values_[key] = {};
    inputs_.clear();
    into.code_.assign(code_.begin() + static_cast<ptrdiff_t>(first_), code_.end());
    into.sources_ = sources_;
    into.origins_ = origins_;
    describe(constants, grids, scale, into);
}

Tape TapeBuilder::release(const std::shared_ptr<const std::vector<float>>& constants,
                          const std::shared_ptr<const Grids>& grids, Scale scale) {
    Tape made;
    code_.erase(code_.begin(), code_.begin() + static_cast<ptrdiff_t>(first_));
    made.code_ = std::move(code_), made.sources_ = std::move(sources_), made.origins_ = std::move(origins_);
    describe(constants, grids, scale, made);
    return made;
}

void TapeBuilder::describe(const std::shared_ptr<const std::vector<float>>& constants,
                           const std::shared_ptr<const Grids>& grids, Scale scale, Tape& into) const {
    if (into.constants_ != constants) into.constants_ = constants;  // the count of owners is shared between threads
    if (into.grids_ != grids) into.grids_ = grids;
    into.registers_ = registers_;
    into.longest_ = longest_;
    into.result_ = result_;
    into.lipschitz_ = scale.lipschitz;
    into.tieMargin_ = scale.tieMargin;
    into.chosenInputs_ = scale.chosenInputs;
}

void TapeBuilder::rebind(Tape& tape, std::shared_ptr<const std::vector<float>> constants, Scale scale) {
    tape.constants_ = std::move(constants);
    tape.lipschitz_ = scale.lipschitz;
    tape.tieMargin_ = scale.tieMargin;
    tape.chosenInputs_ = scale.chosenInputs;
}

}  // namespace sgm::eval
