// Exact predicates on a lattice of 2⁻²⁰ m.
// Enters: points in metres within 2²⁰ m of 0. Leaves: decisions without rounding. Assumes finite coordinates.
#pragma once

#include <compare>
#include <cstdint>

#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// Lattice units in a metre.
inline constexpr double unitsPerMetre = 1 << 20;

/// A point of the lattice, |coordinate| ≤ 2⁴⁰ units. Differences fit into 2⁴¹, their products into 2⁸².
struct LatticePoint {
    int64_t x = 0, z = 0;
    friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
    friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
    friend LatticePoint operator-(LatticePoint a, LatticePoint b) { return {a.x - b.x, a.z - b.z}; }
    friend LatticePoint operator+(LatticePoint a, LatticePoint b) { return {a.x + b.x, a.z + b.z}; }
    friend LatticePoint operator-(LatticePoint a) { return {-a.x, -a.z}; }
};

/// As std::llround, which is a call.
inline int64_t nearestUnit(double units) {
    const auto whole = static_cast<int64_t>(units);
    const double rest = units - static_cast<double>(whole);
    return whole + (rest >= .5) - (rest <= -.5);
}
inline LatticePoint latticePoint(Vec2 p) {
    return {nearestUnit(p.x * unitsPerMetre), nearestUnit(p.z * unitsPerMetre)};
}
inline Vec2 metres(LatticePoint p) {
    return {static_cast<double>(p.x) / unitsPerMetre, static_cast<double>(p.z) / unitsPerMetre};
}

__extension__ typedef __int128 Wide;

inline Wide wideCross(LatticePoint a, LatticePoint b) {
    return static_cast<Wide>(a.x) * b.z - static_cast<Wide>(a.z) * b.x;
}
inline Wide wideDot(LatticePoint a, LatticePoint b) {
    return static_cast<Wide>(a.x) * b.x + static_cast<Wide>(a.z) * b.z;
}
inline int signOf(Wide v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

/// 1 where a, b, c turn left, −1 right, 0 straight.
inline int turn(LatticePoint a, LatticePoint b, LatticePoint c) { return signOf(wideCross(b - a, c - a)); }

/// Whether p lies on the segment from a to b, ends included.
inline bool onSegment(LatticePoint a, LatticePoint b, LatticePoint p) {
    return turn(a, b, p) == 0 && wideDot(a - p, b - p) <= 0;
}

/// Whether two segments share a point, ends included.
inline bool meet(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    const int abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return onSegment(a, b, c) || onSegment(a, b, d) || onSegment(c, d, a) || onSegment(c, d, b);
}

}  // namespace sgm::plan
