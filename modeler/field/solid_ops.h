// Whole solids as ops: a ball or a box is one instruction instead of some twenty.
// Enters: a position, then numbers that are the same at every point: the solid's centre in the position's frame and its
// size, metres, > 0. Leaves: its field, with the bounds and derivatives of the geometry. Assumes nothing else.
// Both fields only grow with |x − cx|, |y − cy|, |z − cz|, and so do their floats, since − × ÷ √ max round
// monotonically: their bounds over a box are their values at its nearest and its farthest point.
#pragma once

#include <span>
#include <string_view>

#include "modeler/field/values.h"

namespace sgm::field::ops {

namespace detail {

/// Three numbers.
template <class V>
struct Triple {
    V x, y, z;
};

/// A value with its derivatives by the position, x, y and z.
template <class V>
struct Slopes {
    V value;
    Triple<V> by;
};

/// Position less centre: operands 0 … 2 less operands 3 … 5, by `at`.
template <class V, class At>
Triple<V> offset(const At& at) {
    return {at(0) - at(3), at(1) - at(4), at(2) - at(5)};
}

template <class V>
V lengthOf(const Triple<V>& v) {
    return sqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
}

/// 1/v where v > 0, else 0.
template <class V>
V inverse(const V& v) {
    const auto positive = v > V(0.0f);
    return select(positive, V(1.0f) / select(positive, v, V(1.0f)), V(0.0f));
}

/// The offsets of a box's nearest and farthest point.
template <class I>
void offsets(std::span<const I> args, Triple<typename I::Value>& near, Triple<typename I::Value>& far) {
    using V = typename I::Value;
    const auto along = [&](size_t axis, V& least, V& most) {
        const V lo = args[axis].lo - args[axis + 3].lo, hi = args[axis].hi - args[axis + 3].lo;
        least = max(V(0.0f), max(lo, -hi));
        most = max(-lo, hi);
    };
    along(0, near.x, far.x);
    along(1, near.y, far.y);
    along(2, near.z, far.z);
}

/// The derivatives of f(x, y, z) from those of a row by x, y and z.
template <class Row, class D>
D chained(std::span<const D> args) {
    using V = typename D::Value;
    const auto [value, slope] = Row::template slopes<V>([&](size_t i) { return args[i].value; });
    const D &x = args[0], &y = args[1], &z = args[2];
    return D{value, slope.x * x.dx + slope.y * y.dx + slope.z * z.dx, slope.x * x.dy + slope.y * y.dy + slope.z * z.dy,
             slope.x * x.dz + slope.y * y.dz + slope.z * z.dz};
}

}  // namespace detail

/// Distance to a ball, or to an ellipsoid squeezed onto one: |(p − c)·scale| − radius.
struct Ball {
    static constexpr std::string_view name = "ball";
    static constexpr int arity = variadic;
    static constexpr uint32_t cost = 18;
    static constexpr size_t varyingOperands = 3;
    enum Operand : size_t { position, centreAt = 3, scale = 6, radius = 9, operandCount };

    static constexpr GlslNumber glslNumbers[] = {
        {"atPosition", position}, {"atCentre", centreAt}, {"atScale", scale}, {"atRadius", radius}};
    static constexpr std::string_view glsl =
        "vec3 p = arg3(first + atPosition), c = arg3(first + atCentre), s = arg3(first + atScale);\n"
        "return length((p - c) * s) - arg(first + atRadius);";

    template <class V>
    static V apply(std::span<const V> args, uint32_t) {
        const auto at = [&](size_t i) { return args[i]; };
        return detail::lengthOf(scaled(detail::offset<V>(at), at)) - args[radius];
    }
    template <class I>
    static I interval(std::span<const I> args, uint32_t) {
        using V = typename I::Value;
        const auto at = [&](size_t i) { return args[i].lo; };
        detail::Triple<V> near, far;
        detail::offsets(args, near, far);
        const V r = args[radius].lo;
        return I{detail::lengthOf(scaled(near, at)) - r, detail::lengthOf(scaled(far, at)) - r};
    }
    template <class D>
    static D gradient(std::span<const D> args, uint32_t) {
        return detail::chained<Ball>(args);
    }
    /// The derivative at the centre, which has none, is given as 0.
    template <class V, class At>
    static detail::Slopes<V> slopes(const At& at) {
        const detail::Triple<V> u = scaled(detail::offset<V>(at), at), slope = scaled(u, at);
        const V length = detail::lengthOf(u), share = detail::inverse(length);
        return {length - at(radius), {slope.x * share, slope.y * share, slope.z * share}};
    }

private:
    template <class V, class At>
    static detail::Triple<V> scaled(const detail::Triple<V>& d, const At& at) {
        return {d.x * at(scale), d.y * at(scale + 1), d.z * at(scale + 2)};
    }
};

/// Distance to a box: with q = |p − c| − half, |max(q, 0)| + min(max(q.x, q.y, q.z), 0).
struct Box {
    static constexpr std::string_view name = "box";
    static constexpr int arity = variadic;
    static constexpr uint32_t cost = 20;
    static constexpr Pieces pieces = Pieces::Faces;
    static constexpr size_t varyingOperands = 3;
    enum Operand : size_t { position, centreAt = 3, half = 6, operandCount = 9 };

    static constexpr GlslNumber glslNumbers[] = {{"atPosition", position}, {"atCentre", centreAt}, {"atHalf", half}};
    static constexpr std::string_view glsl =
        "vec3 q = abs(arg3(first + atPosition) - arg3(first + atCentre)) - arg3(first + atHalf);\n"
        "return length(max(q, vec3(0.0))) + min(max(max(q.x, q.y), q.z), 0.0);";

    template <class V>
    static V apply(std::span<const V> args, uint32_t) {
        const auto at = [&](size_t i) { return args[i]; };
        const detail::Triple<V> d = detail::offset<V>(at);
        return distance(beyond<V>({abs(d.x), abs(d.y), abs(d.z)}, at));
    }
    template <class I>
    static I interval(std::span<const I> args, uint32_t) {
        using V = typename I::Value;
        const auto at = [&](size_t i) { return args[i].lo; };
        detail::Triple<V> near, far;
        detail::offsets(args, near, far);
        return I{distance(beyond(near, at)), distance(beyond(far, at))};
    }
    template <class D>
    static D gradient(std::span<const D> args, uint32_t) {
        return detail::chained<Box>(args);
    }
    /// Outside they point away from the nearest point; inside, to the nearest face.
    template <class V, class At>
    static detail::Slopes<V> slopes(const At& at) {
        const V zero = 0.0f, one = 1.0f;
        const detail::Triple<V> d = detail::offset<V>(at), q = beyond<V>({abs(d.x), abs(d.y), abs(d.z)}, at);
        const detail::Triple<V> out{max(q.x, zero), max(q.y, zero), max(q.z, zero)};
        const V share = detail::inverse(detail::lengthOf(out));
        const auto outside = share > zero, inX = (q.x >= q.y) & (q.x >= q.z), inY = q.y >= q.z;
        const auto slope = [&](const V& along, const V& away, const V& face) {
            const V size = select(outside, away * share, face);
            return select(along < zero, -size, size);
        };
        return {
            distance(q),
            {slope(d.x, out.x, select(inX, one, zero)), slope(d.y, out.y, select(inX, zero, select(inY, one, zero))),
             slope(d.z, out.z, select(inX | inY, zero, one))}};
    }

private:
    /// How far beyond the faces.
    template <class V, class At>
    static detail::Triple<V> beyond(const detail::Triple<V>& distances, const At& at) {
        return {distances.x - at(half), distances.y - at(half + 1), distances.z - at(half + 2)};
    }
    template <class V>
    static V distance(const detail::Triple<V>& q) {
        const V zero = 0.0f;
        return detail::lengthOf<V>({max(q.x, zero), max(q.y, zero), max(q.z, zero)}) +
               min(max(max(q.x, q.y), q.z), zero);
    }
};

}  // namespace sgm::field::ops
