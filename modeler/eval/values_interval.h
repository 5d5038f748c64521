// The interval value: an enclosure of what the float kernels can return.
// Enters: bounds of the operands. Leaves: bounds of the result. Rounding to nearest is monotone, so the bounds computed
// by the very same float operation enclose every float result; no widening is needed for + − × ÷ √ min max. (Moore,
// "Interval Analysis", 1966, for the extensions.) Bounds that are NaN mean "anything, NaN included"; the kernels pass
// them on (`where`), so the operations here may assume bounds that say something.
#pragma once

#include <limits>

#include "modeler/field/values.h"

namespace sgm::eval {

using field::ops::abs, field::ops::floor, field::ops::max, field::ops::min, field::ops::select, field::ops::sqrt;

/// [lo, hi] over a V (float or Lanes).
template <class V>
struct Interval {
    using Value = V;

    V lo, hi;

    Interval() = default;
    Interval(float value) : lo(value), hi(value) {}
    Interval(V least, V most) : lo(least), hi(most) {}

    friend Interval operator+(Interval a, Interval b) { return {a.lo + b.lo, a.hi + b.hi}; }
    friend Interval operator-(Interval a, Interval b) { return {a.lo - b.hi, a.hi - b.lo}; }
    friend Interval operator*(Interval a, Interval b) {
        const V p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
        // 0 × ∞ gives NaN, which min and max would lose: the sum keeps it.
        const V nan = ((p + q) + (r + s)) * V(0.0f);
        return {min(min(p, q), min(r, s)) + nan, max(max(p, q), max(r, s)) + nan};
    }
    friend Interval operator/(Interval a, Interval b) {
        const V p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
        const V nan = ((p + q) + (r + s)) * V(0.0f);
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const auto pole = (b.lo <= V(0.0f)) & (b.hi >= V(0.0f));
        // At a pole anything is possible, 0/0 = NaN too when a holds 0.
        const auto zero = (a.lo <= V(0.0f)) & (a.hi >= V(0.0f));
        const V most = select(zero, V(std::numeric_limits<float>::quiet_NaN()), V(infinity) + a.lo + a.hi);
        return {select(pole, -most, min(min(p, q), min(r, s)) + nan),
                select(pole, most, max(max(p, q), max(r, s)) + nan)};
    }
    friend Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
    friend Interval min(Interval a, Interval b) { return {min(a.lo, b.lo), min(a.hi, b.hi)}; }
    friend Interval max(Interval a, Interval b) { return {max(a.lo, b.lo), max(a.hi, b.hi)}; }
    friend Interval abs(Interval a) { return {max(V(0.0f), max(a.lo, -a.hi)), max(-a.lo, a.hi)}; }
    friend Interval sqrt(Interval a) { return {sqrt(a.lo), sqrt(a.hi)}; }
    friend Interval floor(Interval a) { return {floor(a.lo), floor(a.hi)}; }

    /// Lanes whose bounds say something.
    friend auto known(Interval a) { return a.lo <= a.hi; }
    /// The same where the mask holds and its own bounds say something; both bounds NaN elsewhere.
    Interval where(field::ops::MaskOf<V> mask) const {
        const auto good = mask & known(*this);
        const V nan = std::numeric_limits<float>::quiet_NaN();
        return {select(good, lo, nan), select(good, hi, nan)};
    }
};

}  // namespace sgm::eval
