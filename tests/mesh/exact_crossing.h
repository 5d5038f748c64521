// Exact test whether two triangles over the edges of one cell cross.
// Enters: places on a cell's edges in integer units. Leaves: a verdict without rounding. Assumes distinct vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "modeler/core/vec.h"
#include "modeler/mesh/marching_cubes.h"

namespace sgm::mesh {

using Point = Vec3<int64_t>;
inline constexpr int64_t gridUnits = 1024;  ///< of one cell's edge; 1 is the margin vertices keep

/// A point on each edge of the unit cell, `place(edge)` units from its low end.
template <class Place>
std::array<Point, edgesPerCell> pointsOnEdges(Place&& place) {
    std::array<Point, edgesPerCell> at;
    for (int e = 0; e < edgesPerCell; ++e) {
        const int c = edgeCorner(e);
        at[e] = Point{c & 1, c >> 1 & 1, c >> 2} * gridUnits;
        at[e][edgeAxis(e)] += place(e);
    }
    return at;
}

/// Sign of the volume of abcd: positive when d lies on the side from which abc runs counter-clockwise.
inline int orient(Point a, Point b, Point c, Point d) {
    const int64_t v = dot(cross(b - a, c - a), d - a);
    return (v > 0) - (v < 0);
}

/// Does the closed segment pq meet the closed triangle abc? False when all five are coplanar.
inline bool meets(Point p, Point q, Point a, Point b, Point c) {
    const int sp = orient(a, b, c, p), sq = orient(a, b, c, q);
    if (sp * sq > 0 || (sp == 0 && sq == 0)) return false;
    const int u = orient(p, q, a, b), v = orient(p, q, b, c), w = orient(p, q, c, a);
    return !(std::max({u, v, w}) > 0 && std::min({u, v, w}) < 0);
}

/// Do two triangles, given by edges of the cell, share more than the corners and the side they have in common?
inline bool cross(std::array<int, 3> s, std::array<int, 3> t, const std::array<Point, edgesPerCell>& at) {
    const auto has = [](const std::array<int, 3>& list, int e) {
        return std::find(list.begin(), list.end(), e) != list.end();
    };
    // The common corners first in both.
    const auto shared = std::partition(s.begin(), s.end(), [&](int e) { return has(t, e); }) - s.begin();
    std::partition(t.begin(), t.end(), [&](int e) { return has(s, e); });
    const auto sideMeets = [&](int p, int q, const std::array<int, 3>& tri) {
        return meets(at[p], at[q], at[tri[0]], at[tri[1]], at[tri[2]]);
    };
    switch (shared) {
        case 0:
            for (int i = 0; i < 3; ++i)
                if (sideMeets(s[i], s[(i + 1) % 3], t) || sideMeets(t[i], t[(i + 1) % 3], s)) return true;
            return false;
        case 1:
            return sideMeets(s[1], s[2], t) || sideMeets(t[1], t[2], s);
        case 2: {  // they overlap only when folded flat onto each other
            if (orient(at[s[0]], at[s[1]], at[s[2]], at[t[2]]) != 0) return false;
            const Point side = at[s[1]] - at[s[0]];
            return dot(cross(side, at[s[2]] - at[s[0]]), cross(side, at[t[2]] - at[s[0]])) >= 0;
        }
        default:
            return true;
    }
}

}  // namespace sgm::mesh
