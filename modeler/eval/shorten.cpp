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

/// What of the result matters, as far as operands can show it. Of a blend f = c − k with the least operand m, where
/// m − k ≤ f ≤ m and an operand counts below m + k alone: those above most + 2k don't where f ≤ most, and elsewhere
/// leave f above it. The rest is for rounding.
RelevantRange relevantRangeOfResult(const Tape& tape, const Instruction& in, const Source* values,
                                    RelevantRange relevant) {
    if (in.op != field::codeOf<field::ops::Blend> || !isConstant(values[0])) return {};
    const float twice = 2 * tape.constants()[indexOf(values[0])];
    if (!(twice >= 0)) return {};
    return {relevant.least, relevant.most + twice + 1e-5f * (std::abs(relevant.most) + twice)};
}

/// What matters of the operands of an op that chooses, and with it what may be dropped. `pruneBound` is the op's own,
/// NaN where an operand is unknown: then nothing may be dropped, since a NaN takes sides by its place. An operand that
/// ties with the chosen one stays, for labels go to the first of those that tie.
RelevantRange relevantRangeOfOperands(const field::OpTraits& row, float pruneBound, RelevantRange outer,
                                      float tieMargin) {
    if (std::isnan(pruneBound)) return {};
    if (row.owner == Owner::Least) return {outer.least, std::min(outer.most, pruneBound + tieMargin)};
    return {std::max(outer.least, pruneBound - tieMargin), outer.most};
}

/// True where no value of the operand is told apart. Strict: at a tie ±0 could differ.
bool beyond(const field::OpTraits& row, float bound, RelevantRange relevant) {
    return row.owner == Owner::Least ? bound > relevant.most : bound < relevant.least;
}

/// What of its first three operands matters to an instruction that doesn't choose; of others all does.
using RelevantOperands = std::array<RelevantRange, 3>;

/// `relevant` with both ends sent through `move`, and a little wider: the operation rounds numbers as large as `by`.
template <class Move>
RelevantRange moved(RelevantRange relevant, float by, Move&& move) {
    const auto slack = [&](float end) { return 1e-6f * (std::abs(end) + std::abs(by)); };
    const float least = move(relevant.least), most = move(relevant.most);
    const RelevantRange all;
    return {least - slack(least) <= most ? least - slack(least) : all.least,
            most + slack(most) >= least ? most + slack(most) : all.most};
}

/// A difference of two values a − b, from the range of b: a counts between least + lo and most + hi.
std::optional<RelevantOperands> throughDifference(const float* range, RelevantRange relevant) {
    const float lo = range[0], hi = range[maxBoxes];
    if (!(lo <= hi)) return {};
    const auto plus = [](float n) { return [n](float end) { return end + n; }; };
    return RelevantOperands{RelevantRange{moved(relevant, lo, plus(lo)).least, moved(relevant, hi, plus(hi)).most}};
}

/// A morph a (1 − t) + b t by a number t: neither counts above what the other at its lowest leaves it. Both may be
/// above at once, for the two at their lowest stay below `most`; from below the same would hold for but one of them.
std::optional<RelevantOperands> throughMorph(const float* range, float t, RelevantRange relevant) {
    const float s = 1 - t, a = range[0], b = range[maxBoxes], most = relevant.most;
    if (!(t > 0 && t < 1) || !(a * s + b * t <= most)) return {};
    const auto left = [most](float own, float others, float other) {
        const float end = (most - others * other) / own;
        return end + 1e-5f * (std::abs(end) + (std::abs(most) + std::abs(other)) / own);
    };
    return RelevantOperands{RelevantRange{RelevantRange{}.least, left(s, t, b)},
                            RelevantRange{RelevantRange{}.least, left(t, s, a)}};
}

/// What an instruction's operands pass on of what its result's consumers tell apart; nothing where all of it matters.
/// `range`: the rows of UseDefChains::bounds.
std::optional<RelevantOperands> passedOn(const Tape& tape, const Instruction& in, const Source* values,
                                         const float* range, RelevantRange relevant) {
    namespace ops = field::ops;
    using field::codeOf;
    const auto is = [&](field::OpCode op) { return in.op == op; };
    const auto number = [&](uint32_t k) { return tape.constants()[indexOf(values[k])]; };
    if (relevant == RelevantRange{}) return {};
    if (is(codeOf<ops::Neg>)) return RelevantOperands{RelevantRange{-relevant.most, -relevant.least}};
    if (is(codeOf<ops::Morph>)) return isConstant(values[2]) ? throughMorph(range, number(2), relevant) : std::nullopt;
    if (needsRange(in)) return throughDifference(range, relevant);
    if (in.count != 2 || isConstant(values[0]) == isConstant(values[1])) return {};
    const uint32_t fixed = isConstant(values[1]) ? 1 : 0;
    const float n = number(fixed);
    RelevantOperands cares;
    RelevantRange& passed = cares[1 - fixed];
    if (is(codeOf<ops::Add>))
        passed = moved(relevant, n, [n](float end) { return end - n; });
    else if (is(codeOf<ops::Sub>) && fixed == 1)
        passed = moved(relevant, n, [n](float end) { return end + n; });
    else if (is(codeOf<ops::Mul>) && n > 0)
        passed = moved(relevant, 0, [n](float end) { return end / n; });
    else if (is(codeOf<ops::Div>) && fixed == 1 && n > 0)
        passed = moved(relevant, 0, [n](float end) { return end * n; });
    else
        return {};
    return cares;
}

/// The owners of an instruction's operands, or null.
const OriginId* ownersOf(const Tape& tape, const Instruction& in) {
    return in.origins ? tape.origins().data() + in.origins - 1 : nullptr;
}

/// The operands that are left of an instruction that chooses, with what of them matters.
void operandsLeft(const field::OpTraits& row, const Instruction& in, const Source* values, const OriginId* origins,
                  const float* bounds, RelevantRange outer, float tieMargin, std::vector<TapeBuilder::Use>& uses) {
    const auto use = [&](uint32_t k, RelevantRange c) { uses.push_back({values[k], origins ? origins[k] : 0, c}); };
    uses.clear();
    const RelevantRange inner = relevantRangeOfOperands(row, bounds[in.count * maxBoxes], outer, tieMargin);
    for (uint32_t k = 0; k < row.firstPrunable; ++k) use(k, {});
    for (uint32_t k = row.firstPrunable; k < in.count; ++k)
        if (!beyond(row, bounds[k * maxBoxes], inner)) use(k, inner);
    // All beyond what the consumer tells apart: any of them will do.
    if (uses.size() == row.firstPrunable) use(row.firstPrunable, inner);
}

/// Goes to a region's parts where the tape's value is a union of them, and says what of them matters.
std::optional<RelevantRange> enterUnion(Workspace::Impl& w, size_t region, RelevantRange relevant, float tieMargin) {
    if (w.parts.empty()) return {};
    const float* const bounds = w.bounds.get(w.chains.boundRows() * maxBoxes);
    if (!w.parts.isClassified(relevant)) w.parts.classify(bounds, w.regions, relevant, tieMargin, w.kernels.notAbove);
    if (!w.parts.enter(region)) return {};
    return relevantRangeOfOperands(field::traits(field::codeOf<field::ops::Min>),
                                   bounds[w.parts.pruneBound() * maxBoxes + region], relevant, tieMargin);
}

/// Of a selection of two, the operands that can matter here; where neither is told apart, any will do.
void selectsLeft(const Tape& tape, const Instruction& in, const Source* operands, const OriginId* origins,
                 const float* ends, uint32_t value, TapeBuilder& b) {
    const field::OpTraits& row = field::traits(in.op);
    const RelevantRange inner = relevantRangeOfOperands(row, ends[2 * maxBoxes], b.relevant(value), tape.tieMargin());
    const bool first = !beyond(row, ends[0], inner), second = !beyond(row, ends[maxBoxes], inner);
    const auto use = [&](uint32_t k) -> TapeBuilder::Use { return {operands[k], origins ? origins[k] : 0, inner}; };
    if (first && second) {
        const TapeBuilder::Use both[] = {use(0), use(1)};
        b.define(value, in, both, 2, origins != nullptr);
    } else {
        b.alias(value, use(second ? 1 : 0));
    }
}

}  // namespace

void shorten(const Tape& tape, size_t index, Workspace& workspace, Tape& into, RelevantRange relevant) {
    Workspace::Impl& w = workspace.impl();
    assert(w.chains.follows(tape) && index < w.regions && &into != &tape);
    const float* const bounds = w.bounds.get(w.chains.boundRows() * maxBoxes) + index;
    TapeBuilder& b = w.builder;
    b.begin(tape.size() + 3);
    for (uint32_t axis = 0; axis < 3; ++axis) b.bindInput(axis, axis);
    const std::optional<RelevantRange> ofParts = enterUnion(w, index, relevant, tape.tieMargin());
    if (ofParts)
        b.result({w.parts.value(), tape.origins()[0] != 0 ? tape.origins()[0] : w.parts.origin(), *ofParts});
    else
        b.result({w.chains.result(), tape.origins()[0], relevant});
    for (uint32_t value = b.nextLive(static_cast<uint32_t>(tape.size()) + 3); value != TapeBuilder::none;
         value = b.nextLive(value)) {
        const size_t i = value - 3;
        const Instruction& in = tape.code()[i];
        const field::OpTraits& row = field::traits(in.op);
        const Source* const operands = w.chains.operands(i);
        const OriginId* const origins = ownersOf(tape, in);
        if (ofParts && w.parts.isMinimum(value)) {
            const UnionParts::Operands& left = w.parts.operands(value);
            const TapeBuilder::Use both[] = {{left.value[0], left.origin[0], *ofParts},
                                             {left.value[1], left.origin[1], *ofParts}};
            b.define(value, in, both, 2, w.parts.listed());
            continue;
        }
        switch (w.chains.pruning(i)) {
            case Pruning::Leaf:
                b.defineLeaf(value, in, operands, origins);
                break;
            case Pruning::Selects:
                selectsLeft(tape, in, operands, origins, bounds + size_t{w.chains.bounds(i)} * maxBoxes, value, b);
                break;
            case Pruning::Chooses:
                operandsLeft(row, in, operands, origins, bounds + size_t{w.chains.bounds(i)} * maxBoxes,
                             relevantRangeOfResult(tape, in, operands, b.relevant(value)), tape.tieMargin(), w.uses);
                if (w.uses.size() == row.firstPrunable + 1u)
                    b.alias(value, w.uses.back());
                else
                    b.define(value, in, w.uses.data(), w.uses.size(), origins != nullptr);
                break;
            case Pruning::NeedsAll: {
                const auto passed =
                    passedOn(tape, in, operands, bounds + size_t{w.chains.bounds(i)} * maxBoxes, b.relevant(value));
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

uint64_t mayLeaveOut(const Tape& tape, size_t instruction, size_t n, Workspace& workspace, RelevantRange relevant) {
    Workspace::Impl& w = workspace.impl();
    assert(w.chains.follows(tape) && n >= 1 && n <= maxBoxes);
    const uint64_t all = n == maxBoxes ? ~uint64_t{0} : (uint64_t{1} << n) - 1;
    const auto chooses = [&](size_t i) { return field::traits(tape.code()[i].op).chooses; };
    size_t choices = 0;
    for (size_t i = 0; i < tape.size(); ++i) choices += chooses(i);
    if (choices == 0) return 0;
    const Source result = w.chains.result();
    if (choices > 1 || isConstant(result) || result < 3 || !chooses(result - 3)) return all;
    const size_t last = result - 3;
    const field::OpTraits& row = field::traits(tape.code()[last].op);
    if (!row.selects || instruction == last) return all;

    // Which values need the instruction.
    std::vector<uint8_t> needs(tape.size() + 3, 0);
    const auto need = [&](Source s) { return !isConstant(s) && needs[s] != 0; };
    for (size_t i = instruction; i < last; ++i) {
        const Source* const values = w.chains.operands(i);
        needs[i + 3] = i == instruction || std::any_of(values, values + tape.code()[i].count, need);
    }
    const Source* const values = w.chains.operands(last);
    if (need(values[0]) == need(values[1])) return need(values[0]) ? 0 : all;
    const bool isFirst = need(values[0]);
    const float* const ends = w.bounds.get(w.chains.boundRows() * maxBoxes) + size_t{w.chains.bounds(last)} * maxBoxes;
    uint64_t out = 0;
    for (size_t i = 0; i < n; ++i) {
        const RelevantRange inner = relevantRangeOfOperands(row, ends[2 * maxBoxes + i], relevant, tape.tieMargin());
        const bool first = !beyond(row, ends[i], inner), second = !beyond(row, ends[maxBoxes + i], inner);
        const bool left = isFirst ? first || !second : second;  // where neither is told apart, the first one is
        out |= uint64_t{!left} << i;
    }
    return out;
}

Tape shorten(const Tape& tape, size_t index, Workspace& workspace, RelevantRange relevant) {
    Tape result;
    shorten(tape, index, workspace, result, relevant);
    return result;
}

}  // namespace sgm::eval
