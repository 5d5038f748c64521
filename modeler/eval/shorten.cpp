// Pruning: going backward, an operand of min, max or blend that can't matter inside the region isn't asked for, and so
// nothing it needs is written. (Keeter, "Massively parallel rendering of complex closed-form implicit surfaces", 2020.)
// Beyond the choice of one instruction we also pass down what the consumers tell apart (RelevantRange): a part of a
// union that is farther than another part of the whole is dropped even where its own neighbours are farther still.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "modeler/eval/left_out.h"
#include "modeler/eval/workspace.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

using field::ops::Owner;

/// An operand that is a number, or one of which nothing is known.
field::OperandRange numberOf(const Tape& tape, Source source) {
    if (!isConstant(source)) return {};
    const float number = tape.constants()[indexOf(source)];
    return {number, number, true};
}

/// What of the result matters, as far as operands can show it.
RelevantRange relevantRangeOfResult(const Tape& tape, const field::OpTraits& row, const Source* values,
                                    RelevantRange relevant) {
    return row.shownBy ? row.shownBy(relevant, numberOf(tape, values[0])) : RelevantRange{};
}

/// What matters of the operands of an op that chooses, and with it what may be dropped. `pruneBound` is the op's own,
/// NaN where an operand is unknown: then nothing may be dropped, since a NaN takes sides by its place. An operand that
/// ties with the chosen one stays, for labels go to the first of those that tie.
RelevantRange relevantRangeOfOperands(Owner owner, float pruneBound, RelevantRange outer, float tieMargin) {
    if (std::isnan(pruneBound)) return {};
    if (owner == Owner::Least) return {outer.least, std::min(outer.most, pruneBound + tieMargin)};
    return {std::max(outer.least, pruneBound - tieMargin), outer.most};
}

/// True where no value of the operand is told apart. Strict: at a tie ±0 could differ.
bool beyond(const field::OpTraits& row, float bound, RelevantRange relevant) {
    return row.owner == Owner::Least ? bound > relevant.most : bound < relevant.least;
}

/// One region's numbers in rows of bounds, by row.
struct BoundRows {
    const float* first;
    size_t stride;
    float operator[](size_t row) const { return first[row * stride]; }
};

/// What an instruction's operands pass on of what its result's consumers tell apart; nothing where all of it matters.
/// `range`: the rows of UseDefChains::bounds.
std::optional<field::RelevantOperands> passedOn(const Tape& tape, const Instruction& in, const field::OpTraits& row,
                                                const Source* values, BoundRows range, RelevantRange relevant) {
    if (!row.passOn || relevant == RelevantRange{}) return {};
    std::array<field::OperandRange, 3> known;
    for (uint32_t k = 0; k < in.count; ++k) known[k] = numberOf(tape, values[k]);
    if (needsRange(in))
        for (uint32_t r = 0; r < 2; ++r) {
            field::OperandRange& of = known[row.keptEnds[r].operand];
            (row.keptEnds[r].high ? of.hi : of.lo) = range[r];
        }
    return row.passOn(relevant, known.data());
}

/// The owners of an instruction's operands, or null.
const OriginId* ownersOf(const Tape& tape, const Instruction& in) {
    return in.origins ? tape.origins().data() + in.origins - 1 : nullptr;
}

/// The operands that are left of an instruction that chooses, with what of them matters.
void operandsLeft(const field::OpTraits& row, const Instruction& in, const Source* values, const OriginId* origins,
                  BoundRows bounds, RelevantRange outer, float tieMargin, std::vector<TapeBuilder::Use>& uses) {
    const auto use = [&](uint32_t k, RelevantRange c) { uses.push_back({values[k], origins ? origins[k] : 0, c}); };
    uses.clear();
    const RelevantRange inner = relevantRangeOfOperands(row.owner, bounds[in.count], outer, tieMargin);
    for (uint32_t k = 0; k < row.firstPrunable; ++k) use(k, {});
    for (uint32_t k = row.firstPrunable; k < in.count; ++k)
        if (!beyond(row, bounds[k], inner)) use(k, inner);
    // All beyond what the consumer tells apart: any of them will do.
    if (uses.size() == row.firstPrunable) use(row.firstPrunable, inner);
}

/// Goes to a region's parts where the tape's value is a union of them, and says what of them matters.
std::optional<RelevantRange> enterUnion(RangeTrace::Impl& t, NotAbove notAbove, size_t region, RelevantRange relevant,
                                        float tieMargin) {
    if (t.parts.empty()) return {};
    if (!t.parts.isClassified(relevant)) t.parts.classify(t.row(0), t.stride, t.regions, relevant, tieMargin, notAbove);
    if (!t.parts.enter(region)) return {};
    return relevantRangeOfOperands(Owner::Least, t.row(t.parts.pruneBound())[region], relevant, tieMargin);
}

/// Of a selection of two, the operands that can matter here; where neither is told apart, any will do.
void selectsLeft(const Tape& tape, const Instruction& in, const Source* operands, const OriginId* origins,
                 BoundRows ends, uint32_t value, TapeBuilder& b) {
    const field::OpTraits& row = field::traits(in.op);
    const RelevantRange inner = relevantRangeOfOperands(row.owner, ends[2], b.relevant(value), tape.tieMargin());
    const bool first = !beyond(row, ends[0], inner), second = !beyond(row, ends[1], inner);
    const auto use = [&](uint32_t k) -> TapeBuilder::Use { return {operands[k], origins ? origins[k] : 0, inner}; };
    if (first && second) {
        const TapeBuilder::Use both[] = {use(0), use(1)};
        b.define(value, in, both, 2, origins != nullptr);
    } else {
        b.alias(value, use(second ? 1 : 0));
    }
}

}  // namespace

void shorten(const Tape& tape, const RangeTrace& trace, size_t index, Workspace& workspace, Tape& into,
             RelevantRange relevant) {
    Workspace::Impl& w = workspace.impl();
    RangeTrace::Impl& t = trace.impl();
    assert(t.chains.follows(tape) && index < t.regions && &into != &tape);
    const auto boundsOf = [&, first = t.row(0) + index, stride = t.stride](size_t i) {
        return BoundRows{first + t.chains.bounds(i) * stride, stride};
    };
    TapeBuilder& b = w.builder;
    b.begin(tape.size() + 3);
    for (uint32_t axis = 0; axis < 3; ++axis) b.bindInput(axis, axis);
    const std::optional<RelevantRange> ofParts = enterUnion(t, w.kernels.notAbove, index, relevant, tape.tieMargin());
    if (ofParts)
        b.result({t.parts.value(), tape.origins()[0] != 0 ? tape.origins()[0] : t.parts.origin(), *ofParts});
    else
        b.result({t.chains.result(), tape.origins()[0], relevant});
    for (uint32_t value = b.nextLive(static_cast<uint32_t>(tape.size()) + 3); value != TapeBuilder::none;
         value = b.nextLive(value)) {
        const size_t i = value - 3;
        const Instruction& in = tape.code()[i];
        const field::OpTraits& row = field::traits(in.op);
        const Source* const operands = t.chains.operands(i);
        const OriginId* const origins = ownersOf(tape, in);
        if (ofParts && t.parts.isMinimum(value)) {
            const UnionParts::Operands& left = t.parts.operands(value);
            const TapeBuilder::Use both[] = {{left.value[0], left.origin[0], *ofParts},
                                             {left.value[1], left.origin[1], *ofParts}};
            b.define(value, in, both, 2, t.parts.listed());
            continue;
        }
        switch (t.chains.pruning(i)) {
            case Pruning::Leaf:
                b.defineLeaf(value, in, operands, origins);
                break;
            case Pruning::Selects:
                selectsLeft(tape, in, operands, origins, boundsOf(i), value, b);
                break;
            case Pruning::Chooses:
                operandsLeft(row, in, operands, origins, boundsOf(i),
                             relevantRangeOfResult(tape, row, operands, b.relevant(value)), tape.tieMargin(), w.uses);
                if (w.uses.size() == row.firstPrunable + 1u)
                    b.alias(value, w.uses.back());
                else
                    b.define(value, in, w.uses.data(), w.uses.size(), origins != nullptr);
                break;
            case Pruning::NeedsAll: {
                const auto passed = passedOn(tape, in, row, operands, boundsOf(i), b.relevant(value));
                if (!passed) {
                    b.define(value, in, operands, origins);
                    break;
                }
                std::array<TapeBuilder::Use, 3> uses;
                for (uint32_t k = 0; k < in.count; ++k) uses[k] = {operands[k], origins ? origins[k] : 0, (*passed)[k]};
                b.define(value, in, uses.data(), in.count, origins != nullptr);
            }
        }
    }
    b.finish(tape.sharedConstants(), tape.grids(), TapeBuilder::scaleOf(tape), into);
}

uint64_t mayLeaveOut(const Tape& tape, size_t instruction, size_t n, const RangeTrace& trace, RelevantRange relevant) {
    RangeTrace::Impl& t = trace.impl();
    assert(t.chains.follows(tape) && n >= 1 && n <= maxBoxes);
    const uint64_t all = n == maxBoxes ? ~uint64_t{0} : (uint64_t{1} << n) - 1;
    const auto chooses = [&](size_t i) { return field::traits(tape.code()[i].op).chooses; };
    size_t choices = 0;
    for (size_t i = 0; i < tape.size(); ++i) choices += chooses(i);
    if (choices == 0) return 0;
    const Source result = t.chains.result();
    if (choices > 1 || isConstant(result) || result < 3 || !chooses(result - 3)) return all;
    const size_t last = result - 3;
    const field::OpTraits& row = field::traits(tape.code()[last].op);
    if (!row.selects || instruction == last) return all;

    // Which values need the instruction.
    std::vector<uint8_t> needs(tape.size() + 3, 0);
    const auto need = [&](Source s) { return !isConstant(s) && needs[s] != 0; };
    for (size_t i = instruction; i < last; ++i) {
        const Source* const values = t.chains.operands(i);
        needs[i + 3] = i == instruction || std::any_of(values, values + tape.code()[i].count, need);
    }
    const Source* const values = t.chains.operands(last);
    if (need(values[0]) == need(values[1])) return need(values[0]) ? 0 : all;
    const bool isFirst = need(values[0]);
    const float* const ends = t.row(t.chains.bounds(last));
    uint64_t out = 0;
    for (size_t i = 0; i < n; ++i) {
        const RelevantRange inner =
            relevantRangeOfOperands(row.owner, ends[2 * t.stride + i], relevant, tape.tieMargin());
        const bool first = !beyond(row, ends[i], inner), second = !beyond(row, ends[t.stride + i], inner);
        const bool left = isFirst ? first || !second : second;  // where neither is told apart, the first one is
        out |= uint64_t{!left} << i;
    }
    return out;
}

Tape shorten(const Tape& tape, const RangeTrace& trace, size_t index, Workspace& workspace, RelevantRange relevant) {
    Tape result;
    shorten(tape, trace, index, workspace, result, relevant);
    return result;
}

}  // namespace sgm::eval
