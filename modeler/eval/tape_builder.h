// Writes a tape from its last instruction to its first, giving out registers on the way.
// Enters: instructions in reverse order, operands as keys (any small integers). Leaves: a Tape. Assumes that a value's
// consumers come before it. Going backward, the first use met of a value is its last in time, so a register is taken
// there and freed at the value's definition: linear scan (Poletto & Sarkar 1999) in one pass.
#pragma once

#include <limits>
#include <vector>

#include "modeler/eval/tape.h"

namespace sgm::eval {

/// Scratch is kept between tapes: nothing but the tape itself is allocated in steady state.
class TapeBuilder {
public:
    static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

    /// What an operand is before it has a register: a constant, or the key of a value; who owns it, and what of it
    /// matters.
    struct Use {
        Source source;
        OriginId origin = 0;
        Care care{};
    };

    /// Starts a tape whose values have keys below `keys`.
    void begin(size_t keys);
    /// Says that `key` is coordinate 0, 1 or 2; those registers are never given to others.
    void bindInput(uint32_t key, uint32_t coordinate);
    /// The tape's value. First call after begin and bindInput.
    void result(Use use);
    /// The greatest key below `below` that something already written needs, inputs apart; `none` when there is none.
    uint32_t nextLive(uint32_t below) const;
    /// What of a live value matters to what is written.
    Care care(uint32_t key) const { return values_[key].care; }
    /// Writes the instruction that defines the live value `key`. `listed`: it keeps the owners of its operands.
    void define(uint32_t key, field::OpCode op, uint32_t data, const Use* operands, size_t count, bool listed);
    /// The same for operands of which everything matters, as instruction `in` has them; `origins` null: not listed.
    void define(uint32_t key, const Instruction& in, const Source* operands, const OriginId* origins);
    /// The live value `key` is the same as `same`: no instruction unless `same` already has a register of its own.
    void alias(uint32_t key, Use same);
    /// The tape, in order, in the memory `into` has.
    void finish(const std::shared_ptr<const std::vector<float>>& constants, const std::shared_ptr<const Grids>& grids,
                float lipschitz, Tape& into);

    /// Gives a tape other numbers, in a table of the same order.
    static void rebind(Tape& tape, std::shared_ptr<const std::vector<float>> constants, float lipschitz);

private:
    /// Where a live value is, and the one place that says who owns it (`none` when several consumers read it).
    struct Value {
        uint32_t reg = none;
        uint32_t owner = none;
        Care care{};
    };
    Source demand(const Use& use, uint32_t ownerEntry);
    bool live(uint32_t key) const { return values_[key].reg != none; }
    void enter(uint32_t key, Value v);
    Value leave(uint32_t key);
    uint32_t takeRegister();
    Instruction begun(uint32_t key, field::OpCode op, uint32_t data, size_t count, bool listed);

    std::vector<Value> values_;       // all dead between tapes
    std::vector<uint64_t> liveBits_;  // by key, inputs apart
    std::vector<uint32_t> inputs_, free_;
    std::vector<Instruction> code_;  // in reverse
    std::vector<Source> sources_;
    std::vector<OriginId> origins_;
    uint32_t registers_ = 3, longest_ = 0;
    Source result_ = 0;
};

}  // namespace sgm::eval
