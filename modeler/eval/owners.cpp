#include "modeler/eval/owners.h"

namespace sgm::eval {

using field::ops::Owner;

namespace {

/// Moves the lanes where `beats` to this operand. `Same`: it has one owner.
template <bool Same, class Beats>
void moveTo(const float* values, const OriginId* owners, OriginId owner, size_t n, float* best, OriginId* taken,
            Beats beats) {
    for (size_t i = 0; i < n; ++i) {
        const bool wins = beats(values[i], best[i]);
        best[i] = wins ? values[i] : best[i];
        taken[i] = wins ? (Same ? owner : owners[i]) : taken[i];
    }
}

}  // namespace

OwnerPass::OwnerPass(const Tape& tape, size_t planes, std::vector<OriginId>& scratch)
    : tape_(tape), planes_(planes), rows_(scratch), owners_(tape.registerCount()) {
    const size_t ids = (tape.registerCount() + size_t{1}) * maxBlock;
    if (rows_.size() < ids) rows_.resize(ids);
    taken_ = rowOf(tape.registerCount());
}

void OwnerPass::gather(const Instruction& in, const field::OpTraits& row, const StepContext& c) {
    const Source direct[] = {in.a, in.b};
    const Source* const sources = row.arity == field::ops::variadic ? c.sources + in.a : direct;
    operands_.clear();
    for (uint32_t k = 0; k < in.count; ++k) {
        const Source s = sources[k];
        const OriginId own = in.origins ? tape_.origins()[in.origins - 1 + k] : 0;
        if (isConstant(s))
            operands_.push_back({nullptr, c.constants[indexOf(s)], {nullptr, own}});
        else
            operands_.push_back({eval::rowOf(c, s, planes_, 0), 0.0f, own != 0 ? Owners{nullptr, own} : owners_[s]});
    }
}

/// True when operands [first, last) all have one owner, the same.
bool OwnerPass::alike(uint32_t first, uint32_t last) const {
    for (uint32_t k = first; k < last; ++k)
        if (operands_[k].owners.row || operands_[k].owners.one != operands_[first].owners.one) return false;
    return true;
}

const float* OwnerPass::valuesOf(const Operand& o, size_t n) {
    if (o.values) return o.values;
    std::fill_n(constant_.data(), n, o.constant);
    return constant_.data();
}

/// The operand from `first` on that no later one beats; ties go to the first.
template <class Beats>
void OwnerPass::takeBest(uint32_t first, size_t n, Beats beats) {
    const Operand& start = operands_[first];
    std::copy_n(valuesOf(start, n), n, best_.data());
    for (size_t i = 0; i < n; ++i) taken_[i] = start.owners.at(i);
    for (size_t k = first + 1; k < operands_.size(); ++k) {
        const Operand& o = operands_[k];
        if (o.owners.row)
            moveTo<false>(valuesOf(o, n), o.owners.row, 0, n, best_.data(), taken_, beats);
        else
            moveTo<true>(valuesOf(o, n), nullptr, o.owners.one, n, best_.data(), taken_, beats);
    }
}

/// Fills taken_ with the owner of the operand that an instruction takes at each point.
void OwnerPass::take(const field::OpTraits& row, size_t n) {
    switch (row.owner) {
        case Owner::Least:
            return takeBest(row.firstChoice, n, [](float a, float b) { return a < b; });
        case Owner::Greatest:
            return takeBest(row.firstChoice, n, [](float a, float b) { return a > b; });
        case Owner::Nearer: {
            const float* const t = valuesOf(operands_[2], n);
            for (size_t i = 0; i < n; ++i) taken_[i] = operands_[t[i] > 0.5f ? 1 : 0].owners.at(i);
            return;
        }
        case Owner::First:
            for (size_t i = 0; i < n; ++i) {
                size_t k = 0;
                while (k + 1 < operands_.size() && operands_[k].owners.at(i) == 0) ++k;
                taken_[i] = operands_[k].owners.at(i);
            }
    }
}

void OwnerPass::operator()(const Instruction& in, const StepContext& c) {
    const field::OpTraits& row = field::traits(in.op);
    gather(in, row, c);
    const uint32_t last = row.owner == Owner::Nearer ? 2 : in.count;
    if (alike(row.firstChoice, last)) {  // most of a tape: the arithmetic below the first union
        owners_[in.out] = operands_[row.firstChoice].owners;
        return;
    }
    take(row, c.count);
    std::copy_n(taken_, c.count, rowOf(in.out));
    owners_[in.out] = {rowOf(in.out), 0};
}

void OwnerPass::store(OriginId* out, size_t n) const {
    const Source s = tape_.result();
    const OriginId own = tape_.origins()[0];
    const Owners owners = own != 0 || isConstant(s) ? Owners{nullptr, own} : owners_[s];
    for (size_t i = 0; i < n; ++i) out[i] = owners.at(i);
}

}  // namespace sgm::eval
