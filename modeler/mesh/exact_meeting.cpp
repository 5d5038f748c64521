#include "modeler/mesh/exact_meeting.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sgm::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point at(std::span<const Vec3f> positions, uint32_t v) { return {positions[v].x, positions[v].y, positions[v].z}; }

/// The plane through a triangle, not quite exactly.
struct RoundedPlane {
    Vec3d at, normal;
    double size;  ///< of the triangle, a bound of its sides by sums of amounts, squared

    RoundedPlane(std::span<const Vec3f> positions, uint32_t a, uint32_t b, uint32_t c) : at(positions[a].as<double>()) {
        const Vec3d u = positions[b].as<double>() - at, v = positions[c].as<double>() - at;
        normal = cross(u, v);
        size = sum(u) * sum(v);
    }
    /// 1 for points above and −1 for those below the plane, 0 where rounding doesn't say.
    int side(Vec3f p) const {
        const Vec3d w = p.as<double>() - at;
        // Of the products of three lengths, well over what rounding in the normal and the dot product makes.
        const double slack = 1e-14 * size * sum(w), height = dot(normal, w);
        return height > slack ? 1 : height < -slack ? -1 : 0;
    }

private:
    static double sum(Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }
};

/// Whether all of t is beyond rounding on one side of the plane through s.
bool isOnOneSide(std::span<const Vec3f> positions, const Triangle& s, const Triangle& t) {
    const RoundedPlane plane(positions, s.x, s.y, s.z);
    const int side = plane.side(positions[t.x]);
    return side != 0 && side == plane.side(positions[t.y]) && side == plane.side(positions[t.z]);
}

/// Whether the side of `s` that isn't at its first vertex meets `t`.
bool farSideMeets(std::span<const Vec3f> positions, const std::array<uint32_t, 3>& s,
                  const std::array<uint32_t, 3>& t) {
    const RoundedPlane plane(positions, t[0], t[1], t[2]);
    const int above = plane.side(positions[s[1]]);
    if (above != 0 && above == plane.side(positions[s[2]])) return false;
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
    if (RoundedPlane(positions, s[0], s[1], s[2]).side(positions[t[2]]) != 0) return false;
    const Point a = at(positions, s[0]), b = at(positions, s[1]), c = at(positions, s[2]), d = at(positions, t[2]);
    return CGAL::coplanar(a, b, c, d) && !CGAL::collinear(a, b, c) &&
           CGAL::coplanar_orientation(a, b, c, d) != CGAL::NEGATIVE;
}

}  // namespace sgm::mesh
