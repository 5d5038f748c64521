// The tape: a field as a straight list of instructions with its constants bound.
// Enters: a graph node and constants (`compile`). Leaves: an immutable program that kernels, intervals, gradients and
// the GPU interpreter run. Assumes the op table of modeler/field/ops.h.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"
#include "modeler/field/field.h"
#include "modeler/field/relevant_range.h"
#include "modeler/field/sampled_grid.h"

namespace sgm::eval {

/// Where an instruction reads: a register, or (bit 31 set) a constant of the tape.
using Source = uint32_t;
inline constexpr Source constantBit = 0x80000000u;
constexpr bool isConstant(Source s) { return (s & constantBit) != 0; }
constexpr uint32_t indexOf(Source s) { return s & ~constantBit; }

/// One step: out = op(a, b), or over `count` sources from `a` in Tape::sources() for variadic ops.
struct Instruction {
    field::OpCode op;
    uint32_t count;        ///< operands; a smooth union of a whole cloud has more than 2¹⁶
    uint32_t out;          ///< register
    Source a = 0;          ///< first operand; for a variadic op its first place in Tape::sources()
    Source b = 0;          ///< second operand
    uint32_t data = 0;     ///< structural integer of the op (KIFS passes, the number of a grid)
    uint32_t origins = 0;  ///< 1 + index of this instruction's operand origins in Tape::origins(), 0 for none
    uint32_t piece = 0;    ///< names the smooth piece of surface that this value makes, 0 where no op chooses from it
};

using field::RelevantRange;

/// The grids of a graph, by number, and their words as kernels read them.
struct Grids {
    explicit Grids(std::vector<field::SampledGridPtr> list);
    std::vector<field::SampledGridPtr> list;
    std::vector<const float*> words;
};

/// An immutable program; registers are reused, so run it forward. Registers 0, 1, 2 hold x, y, z at the start.
class Tape {
public:
    std::span<const Instruction> code() const { return code_; }
    std::span<const Source> sources() const { return sources_; }
    /// Operands of the longest variadic instruction, 0 without any.
    uint32_t longest() const { return longest_; }
    std::span<const float> constants() const { return *constants_; }
    /// Owners of operands, by Instruction::origins; entry 0 is the owner of the result, 0 where the operands decide.
    std::span<const OriginId> origins() const { return origins_; }
    uint32_t registerCount() const { return registers_; }
    /// Where the value is at the end: a register, or a constant for a constant field.
    Source result() const { return result_; }
    size_t size() const { return code_.size(); }
    /// The constants, as shared by all shortened forms.
    const std::shared_ptr<const std::vector<float>>& sharedConstants() const { return constants_; }
    /// What ops that read a grid read, shared likewise; null where there is none.
    const std::shared_ptr<const Grids>& grids() const { return grids_; }
    /// Global Lipschitz constant of the field.
    float lipschitz() const { return lipschitz_; }
    /// Two values that differ by less are equal to evaluateLabels, metres: above the rounding of the field's floats.
    float tieMargin() const { return tieMargin_; }
    /// Which of x, y, z an op of the whole field chooses from, bit by bit: each is a piece of surface then.
    uint32_t chosenInputs() const { return chosenInputs_; }

private:
    friend class TapeBuilder;
    LargePageVector<Instruction> code_;
    LargePageVector<Source> sources_;
    LargePageVector<OriginId> origins_{0};
    std::shared_ptr<const std::vector<float>> constants_;  ///< shared by a tape and all its shortened forms
    std::shared_ptr<const Grids> grids_;
    uint32_t registers_ = 3;
    uint32_t longest_ = 0;
    Source result_ = 0;
    float lipschitz_ = 1;
    float tieMargin_ = 0;
    uint32_t chosenInputs_ = 0;
};

/// Binds `constants` (by SlotId; graph.constants() for the present ones), folds what is constant, orders and allocates.
/// Costs time linear in the graph's nodes. On `threads` threads, 0 for all that the machine has, of which nothing
/// shows in the tape.
Tape compile(const field::Graph& graph, const field::Field& field, std::span<const float> constants, int threads = 0);

}  // namespace sgm::eval
