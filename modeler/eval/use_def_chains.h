// What a tape's instructions read, told by value instead of register, so that a backward pass goes from a value
// straight to what it needs. Enters: a tape. Leaves: for each instruction the values it reads and where its bounds are.
// Assumes one UseDefChains a thread, whose memory is used again.
#pragma once

#include <vector>

#include "modeler/eval/tape.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

/// True where what of an operand matters hangs on the range of another (OpTraits::keptEnds): differences of two values,
/// and morphs.
inline bool needsRange(const Instruction& in) {
    const field::OpTraits& row = field::traits(in.op);
    return row.keptEnds && (row.arity == field::ops::variadic || (!isConstant(in.a) && !isConstant(in.b)));
}

/// Whether an instruction takes the lesser of two operands as it is.
inline bool isMinimum(const Instruction& in) {
    const field::OpTraits& row = field::traits(in.op);
    return row.selects && row.owner == field::ops::Owner::Least;
}

/// What a shorter tape may leave out of an instruction's operands.
enum class Pruning : uint8_t {
    Leaf,     ///< nothing: it reads x, y, z and constants
    Selects,  ///< one of its two operands
    Chooses,  ///< some of its operands
    NeedsAll  ///< nothing, but what its consumers tell apart may bound what matters of them
};

/// x, y, z are values 0, 1, 2 and instruction i makes value 3 + i; constants as in Source.
class UseDefChains {
public:
    /// Follows the tape; what was told of another one is forgotten.
    void build(const Tape& tape);
    /// The operands of instruction i, as many as it has.
    const Source* operands(size_t i) const { return values_.data() + chains_[i].first; }
    /// Its first row of bounds, if it chooses or `needsRange` (evaluateRanges).
    uint32_t bounds(size_t i) const { return chains_[i].bounds; }
    Pruning pruning(size_t i) const { return chains_[i].pruning; }
    /// Rows of bounds of all instructions: where they choose one an operand and one for the reach; else the two
    /// of OpTraits::keptEnds.
    uint32_t boundRows() const { return boundRows_; }
    /// How many operands a value is.
    uint32_t readers(uint32_t value) const { return readers_[value]; }
    Source result() const { return result_; }
    /// True for the tape followed last.
    bool follows(const Tape& tape) const { return code_ == tape.code().data(); }

private:
    struct Link {
        uint32_t first, bounds;
        Pruning pruning;
    };
    std::vector<Source> values_, holder_;
    std::vector<uint32_t> readers_;
    std::vector<Link> chains_;
    uint32_t boundRows_ = 0;
    Source result_ = 0;
    const Instruction* code_ = nullptr;
};

}  // namespace sgm::eval
