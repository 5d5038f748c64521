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

/// Corners of a triangle; those that another one shares come first.
using Corners = std::array<Vec3d, 3>;

double sum(Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// The plane through a triangle, not quite exactly.
struct RoundedPlane {
    Vec3d at, normal;
    double size;  ///< of the triangle, a bound of its sides by sums of amounts, squared

    explicit RoundedPlane(const Corners& t) : at(t[0]) {
        const Vec3d u = t[1] - at, v = t[2] - at;
        normal = cross(u, v);
        size = sum(u) * sum(v);
    }
    /// 1 for points above and −1 for those below the plane, 0 where rounding doesn't say.
    int side(Vec3d p) const {
        const Vec3d w = p - at;
        // Of the products of three lengths, well over what rounding in the normal and the dot product makes.
        const double slack = 1e-14 * size * sum(w), height = dot(normal, w);
        return height > slack ? 1 : height < -slack ? -1 : 0;
    }
    /// Whether a triangle's corners from the first-th on are all beyond rounding on one side.
    bool hasOnOneSide(const Corners& t, size_t first) const {
        const int before = side(t[first]);
        for (size_t i = first + 1; i < 3; ++i)
            if (side(t[i]) != before) return false;
        return before != 0;
    }
};

/// Two triangles seen along an axis: where a line through a side of one parts them, they don't meet in space.
class Shadows {
public:
    explicit Shadows(Vec3d normal) {
        const Vec3d n{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
        const int dropped = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
        u_ = (dropped + 1) % 3, v_ = (dropped + 2) % 3;
    }
    /// Whether the triangles meet in nothing but their first `common` corners, which are the same.
    bool areApart(const Corners& s, const Corners& t, size_t common) const {
        return isPartedBySide(s, t, common) || (common < 2 && isPartedBySide(t, s, common));
    }

private:
    /// 1 where a, b, p turn left, −1 where they turn right, 0 where rounding doesn't say.
    int turn(Vec3d a, Vec3d b, Vec3d p) const {
        const double left = (b[u_] - a[u_]) * (p[v_] - a[v_]), right = (b[v_] - a[v_]) * (p[u_] - a[u_]);
        const double slack = 1e-14 * (std::abs(left) + std::abs(right)), twice = left - right;
        return twice > slack ? 1 : twice < -slack ? -1 : 0;
    }
    /// By the line through a side of s on which the common corners lie.
    bool isPartedBySide(const Corners& s, const Corners& t, size_t common) const {
        for (size_t i = 0; i < 3; ++i) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            if (k < common) continue;
            const int inside = turn(s[i], s[j], s[k]);
            if (inside == 0) continue;
            bool parts = true;
            for (size_t c = common; c < 3 && parts; ++c) parts = turn(s[i], s[j], t[c]) == -inside;
            if (parts) return true;
        }
        return false;
    }

    int u_, v_;
};

Point pointAt(Vec3d p) { return {p.x, p.y, p.z}; }
Kernel::Triangle_3 triangleOf(const Corners& t) { return {pointAt(t[0]), pointAt(t[1]), pointAt(t[2])}; }

/// Whether the side of `s` that isn't at its first corner meets `t`.
bool farSideMeets(const Corners& s, const Corners& t) {
    const Kernel::Segment_3 side(pointAt(s[1]), pointAt(s[2]));
    const Kernel::Triangle_3 triangle = triangleOf(t);
    return !triangle.is_degenerate() && !side.is_degenerate() && CGAL::do_intersect(side, triangle);
}

/// As meetWrongly, for triangles whose first `common` corners are the same.
bool meetExactly(const Corners& s, const Corners& t, size_t common) {
    if (common == 0) {
        const Kernel::Triangle_3 a = triangleOf(s), b = triangleOf(t);
        return !a.is_degenerate() && !b.is_degenerate() && CGAL::do_intersect(a, b);
    }
    if (common == 1) return farSideMeets(s, t) || farSideMeets(t, s);
    const Point a = pointAt(s[0]), b = pointAt(s[1]), c = pointAt(s[2]), d = pointAt(t[2]);
    return CGAL::coplanar(a, b, c, d) && !CGAL::collinear(a, b, c) &&
           CGAL::coplanar_orientation(a, b, c, d) != CGAL::NEGATIVE;
}

}  // namespace

bool meetWrongly(std::span<const Vec3f> positions, const Triangle& first, const Triangle& second) {
    std::array<uint32_t, 3> s{first.x, first.y, first.z}, t{second.x, second.y, second.z};
    size_t common = 0;
    for (size_t i = 0; i < 3; ++i)
        for (size_t k = common; k < 3; ++k)
            if (s[i] == t[k]) {
                std::swap(s[i], s[common]), std::swap(t[k], t[common]);
                ++common;
                break;
            }
    if (common == 3) return true;
    const auto at = [&](const std::array<uint32_t, 3>& v) {
        return Corners{positions[v[0]].as<double>(), positions[v[1]].as<double>(), positions[v[2]].as<double>()};
    };
    const Corners a = at(s), b = at(t);
    const RoundedPlane plane(a);
    if (plane.hasOnOneSide(b, common)) return false;
    if (common < 2 && RoundedPlane(b).hasOnOneSide(a, common)) return false;
    return !Shadows(plane.normal).areApart(a, b, common) && meetExactly(a, b, common);
}

}  // namespace sgm::mesh
