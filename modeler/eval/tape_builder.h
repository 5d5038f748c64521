// Writes a tape from its last instruction to its first, giving out registers on the way.
// Enters: instructions in reverse order, operands as keys (any small integers). Leaves: a Tape. Assumes that a value's
// consumers come before it. Going backward, the first use met of a value is its last in time, so a register is taken
// there and freed at the value's definition: linear scan (Poletto & Sarkar 1999) in one pass.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "modeler/eval/tape.h"
#include "modeler/field/ops.h"

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
        RelevantRange relevant{};
    };

    /// See Tape::lipschitz, Tape::tieMargin and Tape::chosenInputs.
    struct Scale {
        float lipschitz, tieMargin;
        uint32_t chosenInputs;
    };

    /// Makes room for a large tape of at most so many, and has the system clear it.
    void reserve(size_t keys, size_t instructions);
    /// Starts a tape whose values have keys below `keys`. A key may stand for another value once its own is defined.
    /// `instructions`: makes room for so many at once.
    void begin(size_t keys, size_t instructions = 0);
    /// Says that `key` is coordinate 0, 1 or 2; those registers are never given to others.
    void bindInput(uint32_t key, uint32_t coordinate);
    /// The tape's value. First call after begin and bindInput.
    void result(Use use);
    /// Whether something already written needs the value.
    bool isLive(uint32_t key) const { return values_[key].reg != none; }
    /// The greatest key below `below` that something already written needs, inputs apart; `none` when there is none.
    uint32_t nextLive(uint32_t below) const;
    /// What of a live value matters to what is written.
    RelevantRange relevant(uint32_t key) const { return values_[key].relevant; }
    /// Writes the instruction that defines the live value `key`: op, data and piece of `like` over these operands.
    /// `listed`: it keeps the owners of its operands.
    void define(uint32_t key, const Instruction& like, const Use* operands, size_t count, bool listed);
    /// The same for operands of which everything matters, as instruction `in` has them; `origins` null: not listed.
    void define(uint32_t key, const Instruction& in, const Source* operands, const OriginId* origins);
    /// The same for an instruction that reads constants and inputs, which have keys 0, 1, 2 as they have registers.
    void defineLeaf(uint32_t key, const Instruction& in, const Source* operands, const OriginId* origins);
    /// The live value `key` is the same as `same`: no instruction unless `same` already has a register of its own.
    void alias(uint32_t key, Use same);
    /// The tape, in order, in the memory `into` has.
    void finish(const std::shared_ptr<const std::vector<float>>& constants, const std::shared_ptr<const Grids>& grids,
                Scale scale, Tape& into);
    /// The same with the memory that the builder has, which is of no use afterwards: for a large tape.
    Tape release(const std::shared_ptr<const std::vector<float>>& constants, const std::shared_ptr<const Grids>& grids,
                 Scale scale);

    /// What a tape says of its field as a whole.
    static Scale scaleOf(const Tape& tape) { return {tape.lipschitz(), tape.tieMargin(), tape.chosenInputs()}; }
    /// Gives a tape other numbers, in a table of the same order.
    static void rebind(Tape& tape, std::shared_ptr<const std::vector<float>> constants, Scale scale);

private:
    /// Where a live value is, and the one place that says who owns it (`none` when several consumers read it).
    struct Value {
        uint32_t reg = none;
        uint32_t owner = none;
        RelevantRange relevant{};
    };
    Source demand(const Use& use, uint32_t ownerEntry);
    void enter(uint32_t key, Value v);
    Value leave(uint32_t key);
    uint32_t takeRegister();
    Instruction& begun(uint32_t key, const Instruction& like, size_t count, bool listed);
    void grow();
    /// Says what doesn't come of instructions.
    void describe(const std::shared_ptr<const std::vector<float>>& constants, const std::shared_ptr<const Grids>& grids,
                  Scale scale, Tape& into) const;

    LargePageVector<Value> values_;   // all dead between tapes
    std::vector<uint64_t> liveBits_;  // by key, inputs apart
    std::vector<uint32_t> inputs_, free_;
    LargePageVector<Instruction> code_;  // written from its end down to `first_`
    size_t first_ = 0;
    LargePageVector<Source> sources_;
    LargePageVector<OriginId> origins_;
    uint32_t registers_ = 3, longest_ = 0;
    Source result_ = 0;
};

// What pruning calls for every value it meets.

inline uint32_t TapeBuilder::takeRegister() {
    if (free_.empty()) return registers_++;
    const uint32_t reg = free_.back();
    free_.pop_back();
    return reg;
}

inline void TapeBuilder::enter(uint32_t key, Value v) {
    values_[key] = v;
    liveBits_[key / 64] |= uint64_t{1} << key % 64;
}

inline TapeBuilder::Value TapeBuilder::leave(uint32_t key) {
    liveBits_[key / 64] &= ~(uint64_t{1} << key % 64);
    return std::exchange(values_[key], Value{});
}

inline uint32_t TapeBuilder::nextLive(uint32_t below) const {
    for (uint32_t word = below / 64 + 1; word-- > 0;) {
        uint64_t bits = liveBits_[word];
        if (word == below / 64) bits &= (uint64_t{1} << below % 64) - 1;
        if (bits != 0) return word * 64 + static_cast<uint32_t>(std::bit_width(bits)) - 1;
    }
    return none;
}

inline Source TapeBuilder::demand(const Use& use, uint32_t ownerEntry) {
    if (isConstant(use.source)) return use.source;
    Value& v = values_[use.source];
    if (v.reg == none) {
        const uint32_t reg = takeRegister();
        enter(use.source, {reg, ownerEntry, use.relevant});
        return reg;
    }
    v.owner = none;
    v.relevant = {std::min(v.relevant.least, use.relevant.least), std::max(v.relevant.most, use.relevant.most)};
    return v.reg;
}

/// The instruction that defines `key`, which is dead from here on; its operands' places are next in the lists.
inline Instruction& TapeBuilder::begun(uint32_t key, const Instruction& like, size_t count, bool listed) {
    if (first_ == 0) grow();
    Instruction& in = code_[--first_];
    in = {like.op, static_cast<uint32_t>(count), leave(key).reg, 0, 0, like.data, 0, like.piece};
    free_.push_back(in.out);
    if (listed) in.origins = static_cast<uint32_t>(origins_.size()) + 1;
    if (field::traits(like.op).arity == field::ops::variadic) {
        in.a = static_cast<Source>(sources_.size());
        longest_ = std::max(longest_, in.count);
    }
    return in;
}

inline void TapeBuilder::alias(uint32_t key, Use same) {
    const uint32_t owner = values_[key].owner;
    // The consumer's own word on the owner goes first; where it says nothing, the operand's stands.
    const bool told = same.origin == 0 || (owner != none && origins_[owner] != 0);
    const bool canTell = owner != none;
    if (!told && canTell) origins_[owner] = same.origin;
    if (!isConstant(same.source) && (same.source == key || !isLive(same.source)) && (told || canTell)) {
        Value v = leave(key);
        v.relevant = same.relevant;
        enter(same.source, v);
    } else {
        define(key, {.op = field::codeOf<field::ops::Copy>, .count = 1, .out = 0}, &same, 1, !told && !canTell);
    }
}

}  // namespace sgm::eval
