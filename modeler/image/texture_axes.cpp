#include "modeler/image/texture_axes.h"

#include <cmath>

namespace sgm::image {
namespace {

/// A face that looks up or down within 2° has no direction of its own that is level.
constexpr double steepest = 0.9995;
/// A component this near to 1 is that of an axis.
constexpr double straight = 1 - 1e-8;

constexpr TextureAxes against[] = {{{0, 0, -1}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, -1}},
                                   {{1, 0, 0}, {0, 0, 1}},  {{1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {0, 1, 0}}};

}  // namespace

TextureAxes axesInPlane(const Mat3& axes, Vec3d normal) {
    const Vec3d local = axes.transposed() * normal;
    Vec3d n = local;
    for (int i = 0; i < 3; ++i)
        if (std::abs(local[i]) > straight) n = Vec3d{}, n[i] = std::copysign(1.0, local[i]);
    Vec3d u, v;
    if (std::abs(n.y) > steepest) {
        u = normalized(Vec3d{1, 0, 0} - n * n.x);
        v = cross(n, u);
    } else {
        v = normalized(Vec3d{0, 1, 0} - n * n.y);
        u = cross(v, n);
    }
    return {axes * u, axes * v};
}

TextureAxes axesAlongNearest(const Mat3& axes, Vec3d normal) {
    const TextureAxes local = axesAgainst(nearestAxis((axes.transposed() * normal).as<float>()));
    return {axes * local.u, axes * local.v};
}

int nearestAxis(Vec3f d) {
    const Vec3f a{std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

TextureAxes axesAgainst(int axis) { return against[axis]; }

}  // namespace sgm::image
