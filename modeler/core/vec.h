// Three-component vectors, axis-aligned boxes, 3x3 matrices and rigid frames.
// Enters: plain numbers. Leaves: plain values, no allocation. Assumes nothing; see conventions.h for axes and units.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sgm {

/// A point, direction or size with components of type T.
template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
    /// Component by component, as S_J ⊙ u·r in the papers guide.
    friend constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
    friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
    constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }

    /// The same numbers in another component type.
    template <class U>
    constexpr Vec3<U> as() const {
        return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
    }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec3i = Vec3<int32_t>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vec3<T> a) {
    return std::sqrt(dot(a, a));
}
/// `a` scaled to unit length, or `a` itself when its length is zero.
template <class T>
Vec3<T> normalized(Vec3<T> a) {
    const T l = length(a);
    return l > T(0) ? a / l : a;
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
constexpr T minComponent(Vec3<T> a) {
    return std::min({a.x, a.y, a.z});
}
template <class T>
constexpr T maxComponent(Vec3<T> a) {
    return std::max({a.x, a.y, a.z});
}

/// An axis-aligned box [lo, hi]. The default box is empty: lo > hi in every component.
template <class T>
struct Box3 {
    Vec3<T> lo{limit(), limit(), limit()};
    Vec3<T> hi{-limit(), -limit(), -limit()};

    friend constexpr bool operator==(const Box3&, const Box3&) = default;
    constexpr bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    constexpr Vec3<T> size() const { return hi - lo; }
    constexpr Vec3<T> centre() const { return (lo + hi) * T(0.5); }
    /// True when every bound is a finite number (a half-space has none).
    bool finite() const {
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(lo[i]) < limit()) || !(std::abs(hi[i]) < limit())) return false;
        return true;
    }
    constexpr bool contains(Vec3<T> p) const {
        return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
    }
    /// This box grown by `margin` on every side (shrunk when negative); an empty box stays empty.
    constexpr Box3 inflated(T margin) const {
        if (empty()) return *this;
        const Vec3<T> m{margin, margin, margin};
        return {lo - m, hi + m};
    }
    template <class U>
    constexpr Box3<U> as() const {
        return {lo.template as<U>(), hi.template as<U>()};
    }
    /// The whole space.
    static constexpr Box3 everything() { return {{-limit(), -limit(), -limit()}, {limit(), limit(), limit()}}; }
    static constexpr T limit() {
        return std::numeric_limits<T>::has_infinity ? std::numeric_limits<T>::infinity()
                                                    : std::numeric_limits<T>::max();
    }
};

using Box3f = Box3<float>;
using Box3d = Box3<double>;

/// The smallest box that holds both.
template <class T>
constexpr Box3<T> hull(const Box3<T>& a, const Box3<T>& b) {
    return {min(a.lo, b.lo), max(a.hi, b.hi)};
}
template <class T>
constexpr Box3<T> hull(const Box3<T>& a, Vec3<T> p) {
    return {min(a.lo, p), max(a.hi, p)};
}
/// What both boxes share; empty when they don't meet.
template <class T>
constexpr Box3<T> intersection(const Box3<T>& a, const Box3<T>& b) {
    return {max(a.lo, b.lo), min(a.hi, b.hi)};
}

/// A 3x3 matrix by columns; as a rotation its columns are the images of x, y and z.
struct Mat3 {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
    friend constexpr Vec3d operator*(const Mat3& m, Vec3d v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
    friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.x, a * b.y, a * b.z}; }
    constexpr Mat3 transposed() const { return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}; }
    /// Rotation by `angle` radians about `axis` (need not be unit length), right-handed.
    static Mat3 rotation(Vec3d axis, double angle) {
        const Vec3d u = normalized(axis);
        const double c = std::cos(angle), s = std::sin(angle);
        auto column = [&](Vec3d e) { return e * c + cross(u, e) * s + u * (dot(u, e) * (1 - c)); };
        return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
    }
};

}  // namespace sgm
