#include "modeler/mesh/exact_meeting.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>

namespace sgm::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point at(std::span<const Vec3f> positions, uint32_t v) { return {positions[v].x, positions[v].y, positions[v].z}; }

/// Whether all of t is beyond rounding on one side of the plane through s.
bool isOnOneSide(std::span<const Vec3f> positions, const Triangle& s, const Triangle& t) {
    const Vec3d a = positions[s.x].as<double>(), u = positions[s.y].as<double>() - a,
                v = positions[s.z].as<double>() - a;
    const Vec3d n = cross(u, v);
    bool above = true, below = true;
    for (int i = 0; i < 3; ++i) {
        const Vec3d w = positions[t[i]].as<double>() - a;
        // Of the products of three lengths, well over what rounding in `n` and the dot product makes.
        const double slack = 1e-14 * (std::abs(u.x) + std::abs(u.y) + std::abs(u.z)) *
                             (std::abs(v.x) + std::abs(v.y) + std::abs(v.z)) *
                             (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
        const double height = dot(n, w);
        above &= height > slack, below &= height < -slack;
    }
    return above || below;
}

/// Whether the side of `s` that isn't at its first vertex meets `t`.
bool farSideMeets(std::span<const Vec3f> positions, const std::array<uint32_t, 3>& s,
                  const std::array<uint32_t, 3>& t) {
    const Kernel::Segment_3 side(at(positions, s[1]), at(positions, s[2]));
    const Kernel::Triangle_3 triangle(at(positions, t[0]), at(positions, t[1]), at(positions, t[2]));
    return !triangle.is_degenerate() && !side.is_degenerate() && CGAL::do_intersect(side, triangle);
}

}  // namespace

bool meetWrongly(std::span<const Vec3f> positions, const Triangle& first, const Triangle& second) {
    std::array<uint32_t, 3> s{first.x, first.y, first.z}, t{second.x, second.y, second.z};
    const auto has = [](const std::array<uint32_t, 3>& list, uint32_t v) {
        return std::find(list.begin(), list.end(), v) != list.end();
    };
    // Common vertices first in both.
    const auto common = std::stable_partition(s.begin(), s.end(), [&](uint32_t v) { return has(t, v); }) - s.begin();
    std::stable_partition(t.begin(), t.end(), [&](uint32_t v) { return has(s, v); });
    if (common == 0) {
        if (isOnOneSide(positions, first, second) || isOnOneSide(positions, second, first)) return false;
        const Kernel::Triangle_3 a(at(positions, s[0]), at(positions, s[1]), at(positions, s[2])),
            b(at(positions, t[0]), at(positions, t[1]), at(positions, t[2]));
        return !a.is_degenerate() && !b.is_degenerate() && CGAL::do_intersect(a, b);
    }
    if (common == 1) return farSideMeets(positions, s, t) || farSideMeets(positions, t, s);
    if (common == 3) return true;
    const Point a = at(positions, s[0]), b = at(positions, s[1]), c = at(positions, s[2]), d = at(positions, t[2]);
    return CGAL::coplanar(a, b, c, d) && !CGAL::collinear(a, b, c) &&
           CGAL::coplanar_orientation(a, b, c, d) != CGAL::NEGATIVE;
}

}  // namespace sgm::mesh
