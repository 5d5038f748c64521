// Two values side by side: a long chain of operations keeps the processor busy when two run at once.
// Enters: two of a V. Leaves: the value interface of modeler/field/values.h but for integers. Assumes nothing; each has
// the bits it would have alone.
#pragma once

#include "modeler/field/values.h"

namespace sgm::eval {

/// Truth of each.
template <class V>
struct PairMask {
    field::ops::MaskOf<V> a, b;

    friend PairMask operator&(PairMask x, PairMask y) { return {x.a & y.a, x.b & y.b}; }
    friend PairMask operator|(PairMask x, PairMask y) { return {x.a | y.a, x.b | y.b}; }
    friend PairMask operator!(PairMask x) { return {!x.a, !x.b}; }
    friend bool any(PairMask x) { return any(x.a | x.b); }
};

template <class V>
struct Pair {
    using Mask = PairMask<V>;
    using Int = void;

    V a, b;

    Pair() = default;
    Pair(float value) : a(value), b(value) {}
    explicit Pair(V both) : a(both), b(both) {}
    Pair(V first, V second) : a(first), b(second) {}

    friend Pair operator+(Pair x, Pair y) { return {x.a + y.a, x.b + y.b}; }
    friend Pair operator-(Pair x, Pair y) { return {x.a - y.a, x.b - y.b}; }
    friend Pair operator*(Pair x, Pair y) { return {x.a * y.a, x.b * y.b}; }
    friend Pair operator/(Pair x, Pair y) { return {x.a / y.a, x.b / y.b}; }
    friend Pair operator-(Pair x) { return {-x.a, -x.b}; }
    friend Mask operator<(Pair x, Pair y) { return {x.a < y.a, x.b < y.b}; }
    friend Mask operator<=(Pair x, Pair y) { return {x.a <= y.a, x.b <= y.b}; }
    friend Mask operator>(Pair x, Pair y) { return {x.a > y.a, x.b > y.b}; }
    friend Mask operator>=(Pair x, Pair y) { return {x.a >= y.a, x.b >= y.b}; }
    friend Pair min(Pair x, Pair y) { return {min(x.a, y.a), min(x.b, y.b)}; }
    friend Pair max(Pair x, Pair y) { return {max(x.a, y.a), max(x.b, y.b)}; }
    friend Pair abs(Pair x) { return {abs(x.a), abs(x.b)}; }
    friend Pair sqrt(Pair x) { return {sqrt(x.a), sqrt(x.b)}; }
    friend Pair floor(Pair x) { return {floor(x.a), floor(x.b)}; }
    friend Pair select(Mask m, Pair x, Pair y) { return {select(m.a, x.a, y.a), select(m.b, x.b, y.b)}; }
};

}  // namespace sgm::eval
