#include "modeler/mesh/crossing.h"

#include <cmath>
#include <vector>

namespace sgm::mesh {
namespace {

/// A triangle with what is asked of it again and again.
struct Face {
    std::array<Vec3d, 3> at;
    Vec3d normal;    ///< of twice the area
    double squares;  ///< product of the squares of two sides

    explicit Face(const std::array<Vec3d, 3>& places) : at(places) {
        const Vec3d u = at[1] - at[0], v = at[2] - at[0];
        normal = cross(u, v);
        squares = dot(u, u) * dot(v, v);
    }
    /// Six times the volume of the tetrahedron with p, 0 within rounding.
    double side(Vec3d p) const {
        const Vec3d w = p - at[0];
        const double volume = dot(normal, w);
        return volume * volume <= 1e-24 * squares * dot(w, w) ? 0 : volume;
    }
};

/// Whether the segment p q, whose ends are on these sides of the triangle, meets it in a plane that it isn't parallel
/// to.
bool meets(const Face& t, Vec3d p, double sp, Vec3d q, double sq) {
    if ((sp > 0 && sq > 0) || (sp < 0 && sq < 0) || (sp == 0 && sq == 0)) return false;
    const double a = Face({p, t.at[0], t.at[1]}).side(q), b = Face({p, t.at[1], t.at[2]}).side(q),
                 c = Face({p, t.at[2], t.at[0]}).side(q);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Whether one of the sides of `of` meets `t`.
bool anySideMeets(const Face& t, const Face& of) {
    const double sides[] = {t.side(of.at[0]), t.side(of.at[1]), t.side(of.at[2])};
    for (size_t i = 0; i < 3; ++i)
        if (const size_t k = (i + 1) % 3; meets(t, of.at[i], sides[i], of.at[k], sides[k])) return true;
    return false;
}

/// Whether the side of `of` that its corner `k` isn't on meets `t`.
bool farSideMeets(const Face& t, const Face& of, int k) {
    const Vec3d p = of.at[static_cast<size_t>((k + 1) % 3)], q = of.at[static_cast<size_t>((k + 2) % 3)];
    return meets(t, p, t.side(p), q, t.side(q));
}

/// Whether two triangles in one plane, or nearly, that share a corner or an edge lie on top of each other.
bool folded(const Face& a, const Face& b) {
    const double along = dot(a.normal, b.normal);
    return along < 0 && along < -0.999999 * length(a.normal) * length(b.normal);
}

bool cross(const Face& a, const Triangle& ta, const Face& b, const Triangle& tb) {
    int shared = 0, sharedOfA = 0, sharedOfB = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (ta[i] == tb[k]) ++shared, sharedOfA = i, sharedOfB = k;
    if (shared >= 2) return folded(a, b);
    if (shared == 1) return farSideMeets(b, a, sharedOfA) || farSideMeets(a, b, sharedOfB);
    return anySideMeets(b, a) || anySideMeets(a, b);
}

}  // namespace

bool anyCross(std::span<const std::array<Vec3f, 3>> places, std::span<const Triangle> triangles) {
    std::vector<Face> faces;
    faces.reserve(triangles.size());
    for (const auto& at : places)
        faces.emplace_back(std::array{at[0].as<double>(), at[1].as<double>(), at[2].as<double>()});
    for (size_t i = 0; i < triangles.size(); ++i)
        for (size_t k = i + 1; k < triangles.size(); ++k)
            if (cross(faces[i], triangles[i], faces[k], triangles[k])) return true;
    return false;
}

}  // namespace sgm::mesh
