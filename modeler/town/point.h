// The lattice of 1 mm that roads stand on, and exact decisions on it.
// Enters: points within 100 km of 0. Leaves: signs without rounding: |differences| ≤ 2·10⁸ mm, so that sums of their
// products stay below 2⁵⁷. Assumes nothing else. No libm: the same bits on every machine.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

#include "modeler/plan/polygon.h"

namespace sgm::town {

using plan::Vec2;

/// Farthest coordinate of a road from 0, metres.
inline constexpr double farthest_m = 1e5;

/// A point of the lattice, millimetres.
struct Point {
    int32_t x = 0, z = 0;
    friend bool operator==(const Point&, const Point&) = default;
    friend auto operator<=>(const Point&, const Point&) = default;
};

/// The nearest point of the lattice; `p` lies within farthest_m.
Point pointAt(Vec2 p);
inline Vec2 metres(Point p) { return {p.x * 1e-3, p.z * 1e-3}; }

/// 1 where a, b, c turn left in the plan (x right, z up the page), −1 right, 0 straight.
int turnOf(Point a, Point b, Point c);
/// Whether two segments share a point, ends included.
bool segmentsMeet(Point a, Point b, Point c, Point d);
/// Whether `p` lies on the segment from a to b, ends included.
bool isOnSegment(Point a, Point b, Point p);

/// The unit vector at `angle` radians from +x towards +z, from + − × ÷ √ alone.
Vec2 directionAt(double angle);
/// `v` turned by the angle of the unit vector `by`.
inline Vec2 turnedBy(Vec2 v, Vec2 by) { return {v.x * by.x - v.z * by.z, v.x * by.z + v.z * by.x}; }
/// The length of `v`, metres: faster than std::hypot, and the same on every machine.
inline double lengthOf(Vec2 v) { return std::sqrt(dot(v, v)); }
/// `v` at length 1; `v` itself where its length is 0.
Vec2 unit(Vec2 v);

}  // namespace sgm::town
