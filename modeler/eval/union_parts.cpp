#include "modeler/eval/union_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sgm::eval {

void UnionParts::build(const Tape& tape, const UseDefChains& chains) {
    parts_.clear();
    classified_ = listed_ = false;
    const auto isMin = [&](Source s) { return !isConstant(s) && s >= 3 && eval::isMinimum(tape.code()[s - 3]); };
    if (!isMin(chains.result())) return;
    pruneBound_ = chains.bounds(chains.result() - 3) + 2;
    minima_.assign(tape.size() + 3, 0);
    stack_.clear();
    for (Part at{chains.result(), 0, 0, 0};; at = stack_.back(), stack_.pop_back()) {
        while (isMin(at.value) && chains.readers(at.value) <= 1) {  // the first operand's parts before the second one's
            minima_[at.value] = 1;
            const size_t i = at.value - 3;
            const Source* const operands = chains.operands(i);
            const uint32_t owners = tape.code()[i].origins;
            listed_ = listed_ || owners != 0;
            const auto origin = [&](uint32_t k) {
                return at.origin != 0 || owners == 0 ? at.origin : tape.origins()[owners - 1 + k];
            };
            const uint32_t bound = chains.bounds(i);
            stack_.push_back({operands[1], origin(1), bound + 1, at.value});
            at = {operands[0], origin(0), bound, at.minimum};
        }
        parts_.push_back(at);
        if (stack_.empty()) break;
    }
    if (operands_.size() < tape.size() + 3) operands_.resize(tape.size() + 3);
}

void UnionParts::classify(const float* bounds, size_t stride, size_t n, RelevantRange relevant, float tieMargin,
                          NotAbove notAbove) {
    alignas(vectorFloats * sizeof(float)) std::array<float, maxBoxes> most{};
    std::array<uint32_t, maxBoxes> count{};
    uint64_t asked = 0;
    for (size_t r = 0; r < n; ++r) {
        const float pruneBound = bounds[pruneBound_ * stride + r];
        most[r] = std::min(relevant.most, pruneBound + tieMargin);
        asked |= uint64_t{!std::isnan(pruneBound)} << r;
    }
    regions_.clear();
    for (const Part& part : parts_) {
        const float* const row = bounds + part.bound * stride;
        uint64_t regions = 0;
        if (stride % vectorFloats == 0)
            regions = notAbove(row, most.data(), stride);
        else
            for (size_t r = 0; r < n; ++r) regions |= uint64_t{!(row[r] > most[r])} << r;
        regions &= asked;
        for (uint64_t rest = regions; rest != 0; rest &= rest - 1) ++count[static_cast<size_t>(std::countr_zero(rest))];
        regions_.push_back(regions);
    }
    starts_[0] = 0;
    for (size_t r = 0; r < maxBoxes; ++r) starts_[r + 1] = starts_[r] + count[r];
    left_.resize(starts_[maxBoxes]);
    std::array<uint32_t, maxBoxes> next;
    std::copy_n(starts_.begin(), maxBoxes, next.begin());
    for (size_t p = 0; p < parts_.size(); ++p)
        for (uint64_t rest = regions_[p]; rest != 0; rest &= rest - 1)
            left_[next[static_cast<size_t>(std::countr_zero(rest))]++] = static_cast<uint32_t>(p);
    classified_ = true;
    relevant_ = relevant;
}

bool UnionParts::enter(size_t region) {
    const uint32_t *part = left_.data() + starts_[region], *const end = left_.data() + starts_[region + 1];
    if (part == end) return false;
    // Of two neighbours the lowest minimum above both is the last one between them. Those that are left by and by are
    // a tree again: the operands of the last are what lies to both sides of it.
    open_.clear();
    value_ = parts_[*part].value;
    origin_ = parts_[*part].origin;
    const auto close = [&] {
        Operands& of = operands_[open_.back()];
        of.value[1] = value_, of.origin[1] = origin_;
        value_ = open_.back(), origin_ = 0;
        open_.pop_back();
    };
    for (const uint32_t* next = part + 1; next != end; part = next++) {
        uint32_t minimum = 0;
        for (uint32_t p = *part + 1; p <= *next; ++p) minimum = std::max(minimum, parts_[p].minimum);
        while (!open_.empty() && open_.back() < minimum) close();
        Operands& own = operands_[minimum];
        own.value[0] = value_, own.origin[0] = origin_;
        open_.push_back(minimum);
        value_ = parts_[*next].value, origin_ = parts_[*next].origin;
    }
    while (!open_.empty()) close();
    return true;
}

}  // namespace sgm::eval
