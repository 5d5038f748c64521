#include "modeler/eval/owners.h"

#include <cstring>

namespace sgm::eval {

using field::ops::Owner;

OwnerPass::OwnerPass(const Tape& tape, Workspace::Impl& workspace)
    : tape_(tape),
      kernels_(workspace.kernels),
      rows_(workspace.owners.get((tape.registerCount() + size_t{1}) * maxBlock)),
      taken_(rowOf(tape.registerCount())),
      owners_(workspace.registerOwners),
      operands_(workspace.ownedOperands) {
    owners_.assign(tape.registerCount(), {});
}

void OwnerPass::gather(const Instruction& in, const Source* sources, const StepContext& c) {
    operands_.clear();
    for (uint32_t k = 0; k < in.count; ++k) {
        const Source s = sources[k];
        const OriginId own = in.origins ? tape_.origins()[in.origins - 1 + k] : 0;
        if (isConstant(s))
            operands_.push_back({nullptr, c.constants[indexOf(s)], {nullptr, own}});
        else
            operands_.push_back({eval::placeOf(c, s, 1, 0), 0.0f, own != 0 ? Owners{nullptr, own} : owners_[s]});
    }
}

/// True when operands [first, last) all have one owner, the same.
bool OwnerPass::alike(uint32_t first, uint32_t last) const {
    for (uint32_t k = first; k < last; ++k)
        if (operands_[k].owners.row || operands_[k].owners.one != operands_[first].owners.one) return false;
    return true;
}

const float* OwnerPass::valuesOf(const OwnedOperand& o, size_t n) {
    if (o.values) return o.values;
    std::fill_n(constant_.data(), n, o.constant);
    return constant_.data();
}

/// The operand from `first` on that no later one beats; ties go to the first.
void OwnerPass::takeBest(uint32_t first, size_t n, ArgMinUpdate move) {
    const OwnedOperand& start = operands_[first];
    std::copy_n(valuesOf(start, n), n, best_.data());
    if (start.owners.row)
        std::copy_n(start.owners.row, n, taken_);
    else
        std::fill_n(taken_, n, std::bit_cast<float>(start.owners.one));
    for (size_t k = first + 1; k < operands_.size(); ++k) {
        const OwnedOperand& o = operands_[k];
        move(valuesOf(o, n), o.owners.row, std::bit_cast<float>(o.owners.one), n, best_.data(), taken_);
    }
}

/// The row of owners that an operand has, where the others are nobody's; else null.
const float* OwnerPass::onlyRow() const {
    const float* row = nullptr;
    for (const OwnedOperand& o : operands_) {
        if (o.owners.one != 0 || (row && o.owners.row)) return nullptr;
        if (o.owners.row) row = o.owners.row;
    }
    return row;
}

/// The lesser or greater of two operands that both move, in one go: `taken` may be the row of either. False where it is
/// another choice.
bool OwnerPass::takeOfTwo(const field::OpTraits& row, size_t n, float* taken) const {
    if (!row.selects || !operands_[0].values || !operands_[1].values) return false;
    const float* const values[] = {operands_[0].values, operands_[1].values};
    const float* const owners[] = {operands_[0].owners.row, operands_[1].owners.row};
    const float ones[] = {std::bit_cast<float>(operands_[0].owners.one), std::bit_cast<float>(operands_[1].owners.one)};
    (row.owner == Owner::Least ? kernels_.ofLesser : kernels_.ofGreater)(values, owners, ones, n, taken);
    return true;
}

/// Fills taken_ with the owner of the operand that an instruction takes at each point.
void OwnerPass::take(const field::OpTraits& row, size_t n) {
    switch (row.owner) {
        case Owner::Least:
            return takeBest(row.firstPrunable, n, kernels_.argMinUpdate);
        case Owner::Greatest:
            return takeBest(row.firstPrunable, n, kernels_.toGreater);
        case Owner::Nearer: {
            const float* const t = valuesOf(operands_[2], n);
            for (size_t i = 0; i < n; ++i)
                taken_[i] = std::bit_cast<float>(operands_[t[i] > 0.5f ? 1 : 0].owners.at(i));
            return;
        }
        case Owner::First:
            for (size_t i = 0; i < n; ++i) {
                size_t k = 0;
                while (k + 1 < operands_.size() && operands_[k].owners.at(i) == 0) ++k;
                taken_[i] = std::bit_cast<float>(operands_[k].owners.at(i));
            }
    }
}

void OwnerPass::operator()(const Instruction& in, const StepContext& c) {
    const field::OpTraits& row = field::traits(in.op);
    const Source direct[] = {in.a, in.b};
    const Source* const sources = row.arity == field::ops::variadic ? c.sources + in.a : direct;
    const auto nobodys = [&](Source s) { return isConstant(s) || (!owners_[s].row && owners_[s].one == 0); };
    if (in.origins == 0 && std::all_of(sources, sources + in.count, nobodys)) {  // most of a tape
        owners_[in.out] = {};
        return;
    }
    gather(in, sources, c);
    if (alike(row.firstPrunable, row.owner == Owner::Nearer ? 2 : in.count)) {
        owners_[in.out] = operands_[row.firstPrunable].owners;
        return;
    }
    if (const float* const only = row.owner == Owner::First ? onlyRow() : nullptr) {
        if (only != rowOf(in.out)) std::copy_n(only, c.count, rowOf(in.out));
    } else if (!takeOfTwo(row, c.count, rowOf(in.out))) {
        take(row, c.count);
        std::copy_n(taken_, c.count, rowOf(in.out));
    }
    owners_[in.out] = {rowOf(in.out), 0};
}

void OwnerPass::store(OriginId* out, size_t n) const {
    const Source s = tape_.result();
    const OriginId own = tape_.origins()[0];
    const Owners owners = own != 0 || isConstant(s) ? Owners{nullptr, own} : owners_[s];
    if (owners.row)
        std::memcpy(out, owners.row, n * sizeof(OriginId));
    else
        std::fill_n(out, n, owners.one);
}

}  // namespace sgm::eval
