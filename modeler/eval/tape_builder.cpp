#include "modeler/eval/tape_builder.h"

#include <utility>

#include "modeler/field/ops.h"

namespace sgm::eval {

void TapeBuilder::begin(size_t keys) {
    values_.assign(keys, Value{});
    free_.clear();
    code_.clear();
    sources_.clear();
    origins_.assign(1, 0);  // entry 0 is the owner of the result
    registers_ = 3;
}

uint32_t TapeBuilder::takeRegister() {
    if (free_.empty()) return registers_++;
    const uint32_t reg = free_.back();
    free_.pop_back();
    return reg;
}

Source TapeBuilder::demand(const Use& use, uint32_t ownerEntry) {
    if (isConstant(use.source)) return use.source;
    Value& v = values_[use.source];
    if (v.reg == none) {
        v = {takeRegister(), ownerEntry};
    } else {
        v.owner = none;
    }
    return v.reg;
}

void TapeBuilder::release(uint32_t key) {
    free_.push_back(values_[key].reg);
    values_[key] = {};
}

void TapeBuilder::result(Use use) {
    origins_[0] = use.origin;
    result_ = demand(use, 0);
}

void TapeBuilder::define(uint32_t key, field::OpCode op, uint32_t data, const Use* operands, size_t count, bool listed) {
    if (!live(key)) return;
    Instruction in{op, static_cast<uint16_t>(count), values_[key].reg};
    in.data = data;
    release(key);
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
    if (!live(key)) return;
    // The parent may keep both in one register: the later value ends here.
    const Value v = std::exchange(values_[key], Value{});
    // The consumer's own word on the owner goes first; where it says nothing, the operand's stands.
    const bool told = same.origin == 0 || (v.owner != none && origins_[v.owner] != 0);
    const bool canTell = v.owner != none;
    if (!told && canTell) origins_[v.owner] = same.origin;
    if (!isConstant(same.source) && !live(same.source) && (told || canTell)) {
        values_[same.source] = v;
        return;
    }
    values_[key] = v;
    define(key, field::codeOf<field::ops::Copy>, 0, &same, 1, !told && !canTell);
}

Tape TapeBuilder::finish(std::shared_ptr<const std::vector<float>> constants, float lipschitz) {
    Tape tape;
    tape.code_.assign(code_.rbegin(), code_.rend());
    tape.sources_ = sources_;
    tape.origins_ = origins_;
    tape.constants_ = std::move(constants);
    tape.registers_ = registers_;
    tape.result_ = result_;
    tape.lipschitz_ = lipschitz;
    return tape;
}

}  // namespace sgm::eval
