#include "modeler/eval/tape_builder.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "modeler/field/ops.h"

namespace sgm::eval {

void TapeBuilder::begin(size_t keys) {
    if (values_.size() < keys) {
        values_.resize(keys);
        liveBits_.resize(keys / 64 + 1);
    }
    free_.clear();
    code_.clear();
    sources_.clear();
    origins_.assign(1, 0);  // entry 0 is the owner of the result
    registers_ = 3;
}

void TapeBuilder::bindInput(uint32_t key, uint32_t coordinate) {
    values_[key].reg = coordinate;
    inputs_.push_back(key);
}

uint32_t TapeBuilder::takeRegister() {
    if (free_.empty()) return registers_++;
    const uint32_t reg = free_.back();
    free_.pop_back();
    return reg;
}

void TapeBuilder::enter(uint32_t key, Value v) {
    values_[key] = v;
    liveBits_[key / 64] |= uint64_t{1} << key % 64;
}

TapeBuilder::Value TapeBuilder::leave(uint32_t key) {
    liveBits_[key / 64] &= ~(uint64_t{1} << key % 64);
    return std::exchange(values_[key], Value{});
}

uint32_t TapeBuilder::nextLive(uint32_t below) const {
    for (uint32_t word = below / 64 + 1; word-- > 0;) {
        uint64_t bits = liveBits_[word];
        if (word == below / 64) bits &= (uint64_t{1} << below % 64) - 1;
        if (bits != 0) return word * 64 + static_cast<uint32_t>(std::bit_width(bits)) - 1;
    }
    return none;
}

Source TapeBuilder::demand(const Use& use, uint32_t ownerEntry) {
    if (isConstant(use.source)) return use.source;
    if (!live(use.source)) {
        enter(use.source, {takeRegister(), ownerEntry, use.care});
    } else {
        Value& v = values_[use.source];
        v.owner = none;
        v.care = {std::min(v.care.least, use.care.least), std::max(v.care.most, use.care.most)};
    }
    return values_[use.source].reg;
}

void TapeBuilder::result(Use use) {
    origins_[0] = use.origin;
    result_ = demand(use, 0);
}

void TapeBuilder::define(uint32_t key, field::OpCode op, uint32_t data, const Use* operands, size_t count,
                         bool listed) {
    Instruction in{op, static_cast<uint32_t>(count), values_[key].reg};
    in.data = data;
    free_.push_back(leave(key).reg);
    if (listed) {
        in.origins = static_cast<uint32_t>(origins_.size()) + 1;
        for (size_t i = 0; i < count; ++i) origins_.push_back(operands[i].origin);
    }
    const auto entry = [&](size_t i) { return listed ? in.origins - 1 + static_cast<uint32_t>(i) : none; };
    if (field::traits(op).arity == field::ops::variadic) {
        in.a = static_cast<Source>(sources_.size());
        for (size_t i = 0; i < count; ++i) sources_.push_back(demand(operands[i], entry(i)));
    } else {
        in.a = demand(operands[0], entry(0));
        if (count > 1) in.b = demand(operands[1], entry(1));
    }
    code_.push_back(in);
}

void TapeBuilder::alias(uint32_t key, Use same) {
    const uint32_t owner = values_[key].owner;
    // The consumer's own word on the owner goes first; where it says nothing, the operand's stands.
    const bool told = same.origin == 0 || (owner != none && origins_[owner] != 0);
    const bool canTell = owner != none;
    if (!told && canTell) origins_[owner] = same.origin;
    if (!isConstant(same.source) && !live(same.source) && (told || canTell)) {
        Value v = leave(key);
        v.care = same.care;
        enter(same.source, v);
    } else {
        define(key, field::codeOf<field::ops::Copy>, 0, &same, 1, !told && !canTell);
    }
}

void TapeBuilder::link(Tape& tape) {
    std::vector<uint32_t> holder(tape.registers_);  // the value each register holds
    for (uint32_t axis = 0; axis < 3; ++axis) holder[axis] = axis;
    const auto valueOf = [&](Source s) { return isConstant(s) ? s : holder[s]; };
    tape.links_.resize(tape.code_.size());
    tape.sourceValues_.resize(tape.sources_.size());
    for (size_t i = 0; i < tape.code_.size(); ++i) {
        const Instruction& in = tape.code_[i];
        const field::OpTraits& row = field::traits(in.op);
        if (row.arity == field::ops::variadic) {
            for (uint32_t k = in.a; k < in.a + in.count; ++k) tape.sourceValues_[k] = valueOf(tape.sources_[k]);
            tape.links_[i] = {in.a, 0, tape.boundRows_};
        } else {
            tape.links_[i] = {valueOf(in.a), in.count > 1 ? valueOf(in.b) : 0, tape.boundRows_};
        }
        if (row.chooses) tape.boundRows_ += in.count + 1u;
        holder[in.out] = static_cast<uint32_t>(i) + 3;
    }
    tape.resultValue_ = valueOf(tape.result_);
}

Tape TapeBuilder::finish(std::shared_ptr<const std::vector<float>> constants, float lipschitz) {
    for (const uint32_t key : inputs_) values_[key] = {};
    inputs_.clear();
    Tape tape;
    tape.code_.assign(code_.rbegin(), code_.rend());
    tape.sources_ = sources_;
    tape.origins_ = origins_;
    tape.constants_ = std::move(constants);
    tape.registers_ = registers_;
    tape.result_ = result_;
    tape.lipschitz_ = lipschitz;
    link(tape);
    return tape;
}

}  // namespace sgm::eval
