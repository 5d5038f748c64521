// How the values of kernels.cpp lie in the register file: planes of floats, a stride apart. For that source alone,
// which is compiled once for each instruction set, hence the namespace without a name. Enters: registers. Leaves:
// vectors of a value type. Assumes rows aligned to whole vectors.
#pragma once

#include "modeler/eval/source_arch.h"
#include "modeler/eval/values_dual.h"
#include "modeler/eval/values_interval.h"
#include "modeler/eval/values_pair.h"
#include "modeler/eval/values_simd.h"

namespace sgm::eval {
namespace {

using Arch = SourceArch;
using Float = Lanes<Arch>;
static_assert(vectorFloats % Float::size == 0);

/// Where an operand is: its first plane, and the others, a stride apart.
struct Place {
    const float* first;
    const float* rest;
    Place from(size_t i) const { return {first + i, rest + i}; }
};

/// How a value type lies in the register file.
template <class V>
struct Planes;
template <>
struct Planes<Float> {
    static constexpr size_t count = 1, floats = Float::size;
    static Float load(Place at, size_t) { return Float::load(at.first); }
    static void store(Float v, float* p, size_t) { v.store(p); }
};
template <>
struct Planes<Pair<Float>> {
    static constexpr size_t count = 1, floats = 2 * Float::size;
    static Pair<Float> row(const float* p) { return {Float::load(p), Float::load(p + Float::size)}; }
    static Pair<Float> load(Place at, size_t) { return row(at.first); }
    static void store(Pair<Float> v, float* p, size_t) {
        v.a.store(p);
        v.b.store(p + Float::size);
    }
};
template <>
struct Planes<Dual<Float>> {
    static constexpr size_t count = 4, floats = Float::size;
    static Dual<Float> load(Place at, size_t stride) {
        return {Float::load(at.first), Float::load(at.rest), Float::load(at.rest + stride),
                Float::load(at.rest + 2 * stride)};
    }
    static void store(Dual<Float> v, float* p, size_t stride) {
        v.value.store(p);
        v.dx.store(p + stride);
        v.dy.store(p + 2 * stride);
        v.dz.store(p + 3 * stride);
    }
};
template <>
struct Planes<Dual<Pair<Float>>> {
    static constexpr size_t count = 4, floats = 2 * Float::size;
    using Row = Planes<Pair<Float>>;
    static Dual<Pair<Float>> load(Place at, size_t stride) {
        return {Row::row(at.first), Row::row(at.rest), Row::row(at.rest + stride), Row::row(at.rest + 2 * stride)};
    }
    static void store(Dual<Pair<Float>> v, float* p, size_t stride) {
        Row::store(v.value, p, 0);
        Row::store(v.dx, p + stride, 0);
        Row::store(v.dy, p + 2 * stride, 0);
        Row::store(v.dz, p + 3 * stride, 0);
    }
};
template <>
struct Planes<Interval<Float>> {
    static constexpr size_t count = 2;
    static Interval<Float> load(Place at, size_t) { return {Float::load(at.first), Float::load(at.rest)}; }
    static void store(Interval<Float> v, float* p, size_t stride) {
        v.lo.store(p);
        v.hi.store(p + stride);
    }
};

}  // namespace
}  // namespace sgm::eval
