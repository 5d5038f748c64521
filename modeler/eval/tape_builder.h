// Writes a tape from its last instruction to its first, giving out registers on the way.
// Enters: instructions in reverse order, operands as keys (any small integers). Leaves: a Tape. Assumes that a value's
// consumers come before it. Going backward, the first use met of a value is its last in time, so a register is taken there
// and freed at the value's definition: linear scan (Poletto & Sarkar 1999) in one pass.
#pragma once

#include <limits>
#include <vector>

#include "modeler/eval/tape.h"

namespace sgm::eval {

/// Scratch is kept between tapes: nothing but the tape itself is allocated in steady state.
class TapeBuilder {
public:
    static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

    /// What an operand is before it has a register: a constant, or the key of a value; and who owns it.
    struct Use {
        Source source;
        OriginId origin = 0;
    };

    /// Starts a tape whose values have keys below `keys`.
    void begin(size_t keys);
    /// Says that `key` is coordinate 0, 1 or 2; those registers are never given to others.
    void bindInput(uint32_t key, uint32_t coordinate) { values_[key].reg = coordinate; }
    /// The tape's value. First call after begin and bindInput.
    void result(Use use);
    /// True when something already written needs the value.
    bool live(uint32_t key) const { return values_[key].reg != none; }
    /// Writes the instruction that defines `key`, if it is live. `listed`: it keeps the owners of its operands.
    void define(uint32_t key, field::OpCode op, uint32_t data, const Use* operands, size_t count, bool listed);
    /// `key` is the same value as `same`: no instruction unless `same` already has a register of its own.
    void alias(uint32_t key, Use same);
    /// The tape, in order.
    Tape finish(std::shared_ptr<const std::vector<float>> constants, float lipschitz);

private:
    /// Where a live value is, and the one place that says who owns it (`none` when several consumers read it).
    struct Value {
        uint32_t reg = none;
        uint32_t owner = none;
    };
    Source demand(const Use& use, uint32_t ownerEntry);
    uint32_t takeRegister();
    void release(uint32_t key);

    std::vector<Value> values_;
    std::vector<uint32_t> free_;
    std::vector<Instruction> code_;   // in reverse
    std::vector<Source> sources_;
    std::vector<OriginId> origins_;
    uint32_t registers_ = 3;
    Source result_ = 0;
};

}  // namespace sgm::eval
