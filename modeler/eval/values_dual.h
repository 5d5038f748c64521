// The dual value: a float with its derivatives by x, y and z (forward differentiation, Wengert 1964).
// Enters: operands with derivatives. Leaves: the result with its own; at a kink those of the chosen operand.
// Assumes nothing; the value has the same bits as without derivatives.
#pragma once

#include <concepts>

#include "modeler/field/values.h"

namespace sgm::eval {

using field::ops::abs, field::ops::floor, field::ops::powerOfTwo, field::ops::select, field::ops::sqrt,
    field::ops::toInt;

/// value and ∂value/∂(x, y, z) over a V (float or Lanes).
template <class V>
struct Dual {
    using Value = V;
    using Mask = field::ops::MaskOf<V>;
    using Int = field::ops::IntOf<V>;

    V value, dx, dy, dz;

    Dual() = default;
    Dual(float v) : value(v), dx(0.0f), dy(0.0f), dz(0.0f) {}
    Dual(V v, V x, V y, V z) : value(v), dx(x), dy(y), dz(z) {}

    friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz}; }
    friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz}; }
    friend Dual operator*(Dual a, Dual b) {
        return {a.value * b.value, a.dx * b.value + a.value * b.dx, a.dy * b.value + a.value * b.dy,
                a.dz * b.value + a.value * b.dz};
    }
    friend Dual operator/(Dual a, Dual b) {
        const V q = a.value / b.value, r = V(1.0f) / b.value;
        return {q, (a.dx - q * b.dx) * r, (a.dy - q * b.dy) * r, (a.dz - q * b.dz) * r};
    }
    // With a number, whose derivatives are 0.
    template <std::same_as<V> N>
    friend Dual operator+(Dual a, N b) {
        return {a.value + b, a.dx, a.dy, a.dz};
    }
    template <std::same_as<V> N>
    friend Dual operator-(Dual a, N b) {
        return {a.value - b, a.dx, a.dy, a.dz};
    }
    template <std::same_as<V> N>
    friend Dual operator-(N a, Dual b) {
        return {a - b.value, -b.dx, -b.dy, -b.dz};
    }
    template <std::same_as<V> N>
    friend Dual operator*(Dual a, N b) {
        return {a.value * b, a.dx * b, a.dy * b, a.dz * b};
    }
    friend Dual operator-(Dual a) { return {-a.value, -a.dx, -a.dy, -a.dz}; }
    friend Mask operator<(Dual a, Dual b) { return a.value < b.value; }
    friend Mask operator<=(Dual a, Dual b) { return a.value <= b.value; }
    friend Mask operator>(Dual a, Dual b) { return a.value > b.value; }
    friend Mask operator>=(Dual a, Dual b) { return a.value >= b.value; }
    friend Dual min(Dual a, Dual b) { return pick(a.value < b.value, a, b); }
    friend Dual max(Dual a, Dual b) { return pick(a.value > b.value, a, b); }
    friend Dual select(Mask m, Dual a, Dual b) { return pick(m, a, b); }
    friend Dual abs(Dual a) {
        const Dual r = pick(a.value < V(0.0f), -a, a);
        return {abs(a.value), r.dx, r.dy, r.dz};
    }
    /// The derivative at 0, which has no bound, is given as 0.
    friend Dual sqrt(Dual a) {
        const V root = sqrt(a.value);
        const auto positive = root > V(0.0f);
        return chain(a, root, select(positive, V(0.5f) / select(positive, root, V(1.0f)), V(0.0f)));
    }
    friend Dual floor(Dual a) { return {floor(a.value), V(0.0f), V(0.0f), V(0.0f)}; }
    friend Dual powerOfTwo(Dual a) { return {powerOfTwo(a.value), V(0.0f), V(0.0f), V(0.0f)}; }
    friend Int toInt(Dual a) { return toInt(a.value); }
    /// f(a) from f's value and slope at a.value.
    friend Dual chain(Dual a, V value, V slope) { return {value, a.dx * slope, a.dy * slope, a.dz * slope}; }

private:
    static Dual pick(Mask m, Dual a, Dual b) {
        return {select(m, a.value, b.value), select(m, a.dx, b.dx), select(m, a.dy, b.dy), select(m, a.dz, b.dz)};
    }
};

}  // namespace sgm::eval
