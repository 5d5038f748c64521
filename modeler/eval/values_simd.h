// The SIMD value: one float a lane.
// Enters: aligned memory or broadcast floats. Leaves: the value interface of modeler/field/values.h over xsimd batches.
// Assumes the translation unit is compiled for A (see kernels.cpp); every A gives the same bits as plain float.
#pragma once

#include <bit>
#include <cstdint>

#include <xsimd/xsimd.hpp>

#include "modeler/field/values.h"

namespace sgm::eval {

/// Truth a lane.
template <class A>
struct LaneMask {
    xsimd::batch_bool<float, A> m;

    friend LaneMask operator&(LaneMask a, LaneMask b) { return {a.m & b.m}; }
    friend LaneMask operator|(LaneMask a, LaneMask b) { return {a.m | b.m}; }
    friend LaneMask operator!(LaneMask a) { return {!a.m}; }
    friend bool any(LaneMask a) { return xsimd::any(a.m); }
};

/// 32 wrapping bits a lane.
template <class A>
struct LaneInts {
    xsimd::batch<uint32_t, A> v;

    LaneInts(uint32_t value) : v(value) {}
    explicit LaneInts(xsimd::batch<uint32_t, A> value) : v(value) {}

    friend LaneInts operator+(LaneInts a, LaneInts b) { return LaneInts(a.v + b.v); }
    friend LaneInts operator-(LaneInts a, LaneInts b) { return LaneInts(a.v - b.v); }
    friend LaneInts operator*(LaneInts a, LaneInts b) { return LaneInts(a.v * b.v); }
    friend LaneInts operator^(LaneInts a, LaneInts b) { return LaneInts(a.v ^ b.v); }
    friend LaneInts operator&(LaneInts a, LaneInts b) { return LaneInts(a.v & b.v); }
    friend LaneInts operator|(LaneInts a, LaneInts b) { return LaneInts(a.v | b.v); }
    friend LaneInts operator<<(LaneInts a, int by) { return LaneInts(a.v << by); }
    friend LaneInts operator>>(LaneInts a, int by) { return LaneInts(a.v >> by); }
};

/// A float a lane.
template <class A>
struct Lanes {
    using Batch = xsimd::batch<float, A>;
    using Mask = LaneMask<A>;
    using Int = LaneInts<A>;
    static constexpr size_t size = Batch::size;

    Batch v;

    Lanes() = default;
    Lanes(float value) : v(value) {}
    explicit Lanes(Batch value) : v(value) {}
    static Lanes load(const float* aligned) { return Lanes(Batch::load_aligned(aligned)); }
    void store(float* aligned) const { v.store_aligned(aligned); }

    friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.v + b.v); }
    friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.v - b.v); }
    friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.v * b.v); }
    friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
    friend Lanes operator-(Lanes a) { return Lanes(a.v ^ Batch(-0.0f)); }
    friend Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
    friend Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
    friend Mask operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
    friend Mask operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
    friend Lanes min(Lanes a, Lanes b) { return Lanes(xsimd::min(a.v, b.v)); }
    friend Lanes max(Lanes a, Lanes b) { return Lanes(xsimd::max(a.v, b.v)); }
    friend Lanes abs(Lanes a) { return Lanes(a.v & Batch(std::bit_cast<float>(0x7fffffffu))); }
    friend Lanes sqrt(Lanes a) { return Lanes(xsimd::sqrt(a.v)); }
    friend Lanes floor(Lanes a) { return Lanes(xsimd::floor(a.v) + Batch(0.0f)); }
    friend Lanes select(Mask m, Lanes a, Lanes b) { return Lanes(xsimd::select(m.m, a.v, b.v)); }
    friend Int toInt(Lanes a) {
        const Batch limit(1073741824.0f);
        const auto whole = xsimd::batch_cast<int32_t>(xsimd::max(xsimd::min(a.v, limit), -limit));
        return Int(xsimd::bitwise_cast<xsimd::batch<uint32_t, A>>(whole));
    }
    friend Lanes powerOfTwo(Lanes a) { return Lanes(xsimd::bitwise_cast<Batch>(((toInt(a) + Int(127u)) << 23).v)); }
};

template <class A>
Lanes<A> gather(const float* table, LaneInts<A> at) {
    return Lanes<A>(Lanes<A>::Batch::gather(table, xsimd::bitwise_cast<xsimd::batch<int32_t, A>>(at.v)));
}

template <class A>
Lanes<A> toFloat(LaneInts<A> a) {
    return Lanes<A>(xsimd::batch_cast<float>(xsimd::bitwise_cast<xsimd::batch<int32_t, A>>(a.v)));
}

}  // namespace sgm::eval
