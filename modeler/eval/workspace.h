// Scratch behind evaluate.h: register files, bounds and the writer of shortened tapes.
// Enters: sizes asked for. Leaves: aligned memory that only grows. Assumes one thread.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <memory>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "modeler/eval/kernels.h"
#include "modeler/eval/tape_builder.h"
#include "modeler/eval/union_parts.h"
#include "modeler/eval/use_def_chains.h"

namespace sgm::eval {

/// Memory aligned for the longest vector; grows, never shrinks.
class AlignedFloats {
public:
    float* get(size_t floats) {
        const size_t lines = (floats + vectorFloats - 1) / vectorFloats;
        if (lines_.size() < lines) lines_.resize(lines);
        return lines_.empty() ? nullptr : lines_.front().v;
    }

    bool empty() const { return lines_.empty(); }

private:
    struct alignas(vectorFloats * sizeof(float)) Line {
        float v[vectorFloats];
    };
    std::vector<Line> lines_;
};

/// Owners of a register or an operand over a block.
struct Owners {
    const float* row = nullptr;  ///< their bits; null where all points have the same
    OriginId one = 0;            ///< then that one; 0 is nobody
    OriginId at(size_t i) const { return row ? std::bit_cast<OriginId>(row[i]) : one; }
};

/// An operand with its owners.
struct OwnedOperand {
    const float* values;  ///< null for a constant
    float constant;
    Owners owners;
};

/// A row of names over a block, or one name for all its points; 0 is none.
struct Names {
    const uint32_t* row = nullptr;
    uint32_t one = 0;
    uint32_t at(size_t i) const { return row ? row[i] : one; }
    bool none() const { return !row && one == 0; }
};

/// What LabelPass knows of a register.
struct PieceNames {
    Names label, origin;
    Names pinched{};  ///< all bits where the solid has no thickness, see LabelPass
};

/// Registers of owners and names, beside those of values.
struct OwnerRegisters {
    AlignedFloats owners;  ///< registers of owners, as bits
    std::vector<Owners> registerOwners;
    std::vector<OwnedOperand> ownedOperands;
    std::vector<uint32_t> nameRows;  ///< three a register: labels, origins, what is pinched
    std::vector<PieceNames> registerNames;
};

/// What points take at a minimum or maximum, bit by bit, see ChosenPaths.
struct Choice {
    uint64_t values = 0;  ///< the second operand's value and, unless they tie, derivatives
    uint64_t names = 0;   ///< the second operand's name
    uint64_t points = 0;  ///< those that need the result
};

/// All bits of masks[i] where bit i is set, none else, for n points and up to seven more. Written so that the compiler
/// makes vectors of it.
inline void spreadBits(uint64_t bits, size_t n, uint32_t* masks) {
    static constexpr uint32_t lanes[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    for (size_t i = 0; i < n; i += 8) {
        const auto byte = static_cast<uint32_t>(bits >> i & 255);
        for (size_t k = 0; k < 8; ++k) masks[i + k] = (byte & lanes[k]) == lanes[k] ? ~0u : 0u;
    }
}

/// Scratch of ChosenPaths.
struct PathRegisters {
    std::vector<Choice> choices;             ///< by instruction
    std::vector<uint64_t> pathReaders;       ///< by register
    std::vector<uint64_t> pathPinched;       ///< by register: points where it is pinched, see LabelPass
    std::vector<uint32_t> liveInstructions;  ///< descending
};

/// What a trace holds.
struct RangeTrace::Impl {
    UseDefChains chains;   ///< of the tape
    UnionParts parts;      ///< likewise
    size_t regions = 0;    ///< that it was asked about
    size_t stride = 0;     ///< floats of a row of bounds: the regions, rounded up where they are many
    AlignedFloats bounds;  ///< see UseDefChains::bounds

    float* row(uint32_t number) { return bounds.get(chains.boundRows() * stride) + size_t{number} * stride; }
};

/// The memory of traces that are gone.
struct RangeTrace::Pool {
    std::vector<std::unique_ptr<Impl>> free;
};

/// Aligned, so that no two threads write to one line of cache, nor to the next one, which processors fetch with it.
struct alignas(128) Workspace::Impl : OwnerRegisters, PathRegisters {
    Kernels kernels;
    Tally* tally = nullptr;  ///< where operations are counted, if at all
    AlignedFloats registers, arguments;
    AlignedFloats points;  ///< copies of coordinates that aren't padded
    AlignedFloats bounds;  ///< rows of one instruction, where a trace keeps fewer floats than kernels write
    std::shared_ptr<RangeTrace::Pool> traces = std::make_shared<RangeTrace::Pool>();
    TapeBuilder builder;
    std::vector<TapeBuilder::Use> uses;

    /// Sets all but where points are and results go, for rows of `stride` floats and a value type of `planes` floats.
    void setUp(StepContext& c, const Tape& tape, size_t planes, size_t stride) {
        const size_t argumentFloats = tape.longest() * (argumentBytes / sizeof(float));
        c.registers = registers.get(tape.registerCount() * planes * stride);
        c.stride = stride;
        for (const float*& rows : c.derivatives) rows = nullptr;
        c.result = nullptr;
        c.constants = tape.constants().data();
        c.sources = tape.sources().data();
        c.grids = tape.grids() ? tape.grids()->words.data() : nullptr;
        c.arguments = argumentFloats > 0 ? arguments.get(argumentFloats) : nullptr;
    }
    /// The same for ranges, with the boxes in the registers of coordinates.
    void setUpRegions(StepContext& c, const Tape& tape, const BoxBatch& regions);
    /// The same for derivatives at n points, n ≤ maxBlock. Strides are few, so that derivatives of coordinates stay
    /// from call to call.
    void setUpGradients(StepContext& c, const Tape& tape, size_t n);

private:
    /// No powers of two, whose rows would evict each other.
    static constexpr size_t gradientStrides[] = {96, 192, 384, maxBlock};
    AlignedFloats derivatives_[std::size(gradientStrides)];  ///< by stride: rows 0 0 1 0 0
};

}  // namespace sgm::eval
