#include "modeler/image/texture_frame.h"

#include <algorithm>
#include <cmath>

#include "modeler/image/texture_axes.h"

namespace sgm::image {
namespace {

/// A face belongs to a side that it turns away from by less than 5°.
constexpr double alike = 0.9962;

/// The square of the distance of a point from a side, seen from above.
double distance2(const TextureSide& side, Vec3d p) {
    const Vec3d from = Vec3d{p.x, 0, p.z} - side.from;
    const Vec3d off = from - side.along * std::clamp(dot(from, side.along), 0.0, side.length_m);
    return dot(off, off);
}

/// The nearest side that looks as the face does; null for faces that look up or down, and where there is none.
const TextureSide* sideOf(const TextureFrame& frame, Vec3d u, Vec3d normal, Vec3d point) {
    const Vec3d right = frame.axes.transposed() * u, n = frame.axes.transposed() * normal;
    if (std::hypot(n.x, n.z) < 0.05) return nullptr;
    const Vec3d p = frame.axes.transposed() * (point - frame.origin);
    const TextureSide* nearest = nullptr;
    double least = 0;
    for (const TextureSide& side : frame.sides) {
        if (dot(side.along, right) < alike) continue;
        const double d = distance2(side, p);
        if (!nearest || d < least) nearest = &side, least = d;
    }
    return nearest;
}

/// The factor that lets whole tiles of `tile_m` fill `extent_m`.
double fitted(double extent_m, double tile_m) {
    return extent_m > 0 ? tile_m * std::max(1.0, std::round(extent_m / tile_m)) / extent_m : 1;
}

/// The frame's size along a direction of the object.
double extent(const TextureFrame& frame, Vec3d direction) {
    const Vec3d d = frame.axes.transposed() * direction;
    return std::abs(d.x) * frame.size_m.x + std::abs(d.y) * frame.size_m.y + std::abs(d.z) * frame.size_m.z;
}

}  // namespace

TextureMap mapFace(const TextureFrame* frame, const Mat3& axes, const Texture* texture, bool flat, Vec3d normal,
                   Vec3d point) {
    const TextureAxes along = flat ? axesInPlane(axes, normal) : axesAlongNearest(axes, normal);
    TextureMap map{along.u, along.v};
    if (!frame) return map;
    const TextureSide* side = flat ? sideOf(*frame, map.u, normal, point) : nullptr;
    const Vec3d from = side ? frame->origin + frame->axes * side->from : frame->origin;
    map.begin_m[0] = dot(from, map.u) - (side ? side->begin_m : 0);
    map.begin_m[1] = dot(from, map.v);
    if (texture && texture->fits) {
        map.stretch[0] = fitted(side ? side->round_m : extent(*frame, map.u), static_cast<double>(texture->width_m));
        map.stretch[1] = fitted(extent(*frame, map.v), static_cast<double>(texture->height_m));
    }
    return map;
}

}  // namespace sgm::image
