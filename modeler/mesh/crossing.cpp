#include "modeler/mesh/crossing.h"

#include <cmath>

namespace sgm::mesh {
namespace {

using Places = std::array<Vec3d, 3>;

/// Six times the volume of a tetrahedron, 0 within rounding.
double side(const Places& t, Vec3d p) {
    const Vec3d u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
    const double volume = dot(cross(u, v), w);
    const double scale = length(u) * length(v) * length(w);
    return std::abs(volume) <= 1e-12 * scale ? 0 : volume;
}

/// Whether the segment p q meets the triangle, in a plane that it isn't parallel to.
bool meets(const Places& t, Vec3d p, Vec3d q) {
    const double sp = side(t, p), sq = side(t, q);
    if ((sp > 0 && sq > 0) || (sp < 0 && sq < 0) || (sp == 0 && sq == 0)) return false;
    const double a = side({p, t[0], t[1]}, q), b = side({p, t[1], t[2]}, q), c = side({p, t[2], t[0]}, q);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Whether two triangles in one plane, or nearly, that share a corner or an edge lie on top of each other.
bool folded(const Places& a, const Places& b) {
    const Vec3d n = cross(a[1] - a[0], a[2] - a[0]), m = cross(b[1] - b[0], b[2] - b[0]);
    return dot(n, m) < -0.999999 * length(n) * length(m);
}

bool cross(const Places& a, const Triangle& ta, const Places& b, const Triangle& tb) {
    int shared = 0, sharedOfA = 0, sharedOfB = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (ta[i] == tb[k]) ++shared, sharedOfA = i, sharedOfB = k;
    if (shared >= 2) return folded(a, b);
    const auto of = [](const Places& p, int i) { return p[static_cast<size_t>(i % 3)]; };
    if (shared == 1)
        return meets(b, of(a, sharedOfA + 1), of(a, sharedOfA + 2)) ||
               meets(a, of(b, sharedOfB + 1), of(b, sharedOfB + 2));
    for (int i = 0; i < 3; ++i)
        if (meets(b, of(a, i), of(a, i + 1)) || meets(a, of(b, i), of(b, i + 1))) return true;
    return false;
}

}  // namespace

bool anyCross(std::span<const std::array<Vec3f, 3>> places, std::span<const Triangle> triangles) {
    const auto exact = [&](size_t i) {
        return Places{places[i][0].as<double>(), places[i][1].as<double>(), places[i][2].as<double>()};
    };
    for (size_t i = 0; i < triangles.size(); ++i)
        for (size_t k = i + 1; k < triangles.size(); ++k)
            if (cross(exact(i), triangles[i], exact(k), triangles[k])) return true;
    return false;
}

}  // namespace sgm::mesh
