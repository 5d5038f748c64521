// Sine, cosine, exponential and angle as ops, from functions whose bits are equal on all machines (ops_math.h).
// Enters: values of any type. Leaves: rows of the op table. Assumes angles in radians.
#pragma once

#include <string_view>

#include "modeler/field/ops_math.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

/// The interval of a sine or cosine from its value in the middle. Of large angles it is known that they have one; an
/// infinite one has none, and of those far out rounding leaves nothing.
template <class I>
I ofTurn(I angle, typename I::Value middle) {
    using V = typename I::Value;
    const V precise = 1e4f, far = 1e6f;
    const V reach = select((angle.lo >= -precise) & (angle.hi <= precise), radius(angle) + 4 * mathError, V(3.0f));
    return around<I>(middle, reach, -1 - mathError, 1 + mathError).where((angle.lo >= -far) & (angle.hi <= far));
}
struct Sin {
    static constexpr std::string_view name = "sin";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 25;
    template <class V>
    static V apply(V a) {
        return sine(a, 0.0f);
    }
    template <class I>
    static I interval(I a) {
        return ofTurn(a, apply(centre(a)));
    }
    template <class D>
    static D gradient(D a) {
        return chain(a, apply(a.value), sine(a.value, 1.0f));
    }
};
struct Cos {
    static constexpr std::string_view name = "cos";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 25;
    template <class V>
    static V apply(V a) {
        return sine(a, 1.0f);
    }
    template <class I>
    static I interval(I a) {
        return ofTurn(a, apply(centre(a)));
    }
    template <class D>
    static D gradient(D a) {
        return chain(a, apply(a.value), -sine(a.value, 0.0f));
    }
};
struct Exp {
    static constexpr std::string_view name = "exp";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 25;
    template <class V>
    static V apply(V a) {
        return exponential(a);
    }
    template <class I>
    static I interval(I a) {
        return I{exponential(a.lo) * (1 - 4 * mathError), exponential(a.hi) * (1 + 4 * mathError)};
    }
    template <class D>
    static D gradient(D a) {
        const auto e = apply(a.value);
        using V = typename D::Value;
        return chain(a, e, select((a.value > V(leastExponent)) & (a.value < V(mostExponent)), e, V(0.0f)));
    }
};
/// Angle of (x, y) from the operands (y, x).
struct Atan2 {
    static constexpr std::string_view name = "atan2";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 40;
    template <class V>
    static V apply(V y, V x) {
        return angleOf(y, x);
    }
    template <class D>
    static D gradient(D y, D x) {
        using V = typename D::Value;
        const V square = x.value * x.value + y.value * y.value;
        const V share = select(square > V(0.0f), V(1.0f) / square, V(0.0f));
        const V a = x.value * share, b = y.value * share;
        return D{apply(y.value, x.value), y.dx * a - x.dx * b, y.dy * a - x.dy * b, y.dz * a - x.dz * b};
    }
    /// Harmonic, so its extremes over a box are on the edges, and monotone along each: at the corners. Not across the
    /// cut.
    template <class I>
    static I interval(I y, I x) {
        using V = typename I::Value;
        const V a = angleOf(y.lo, x.lo), b = angleOf(y.lo, x.hi), c = angleOf(y.hi, x.lo), d = angleOf(y.hi, x.hi);
        const auto cut = (x.lo <= 0.0f) & (y.lo <= 0.0f) & (y.hi >= 0.0f);
        const V whole = 3.1415930f;
        return I{select(cut, -whole, min(min(a, b), min(c, d)) - 4 * mathError),
                 select(cut, whole, max(max(a, b), max(c, d)) + 4 * mathError)};
    }
};

}  // namespace sgm::field::ops
