#include "modeler/town/tensor_field.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

constexpr double degenerate = 1e-6;  // strength below which no direction is told

/// The tensor whose major direction is `d`, of the strength |d|.
Vec2 tensorAlong(Vec2 d) {
    const double l = lengthOf(d);
    return l > 0 ? Vec2{(d.x * d.x - d.z * d.z) / l, 2 * d.x * d.z / l} : Vec2{};
}

/// The major direction of a tensor, by halving the angle.
Vec2 majorOf(Vec2 tensor) {
    const Vec2 twice = unit(tensor);
    const double c = std::sqrt(std::max(0.0, (1 + twice.x) / 2));
    return c > 1e-6 ? unit({c, twice.z / (2 * c)}) : Vec2{0, 1};
}

/// What holds the share 1 at its strongest.
Vec2 atMostOne(Vec2 v) {
    const double l = lengthOf(v);
    return l > 1 ? v * (1 / l) : v;
}

}  // namespace

/// Towards land: the sum of 16 directions by how near water lies along each, at most about 1.
Vec2 TensorField::awayFromWater(Vec2 p) const {
    constexpr int rays = 16, steps = 4;
    if (!land_.water) return {};
    Vec2 sum;
    const bool inWater = land_.water(p);
    for (int i = 0; i < rays; ++i) {
        const Vec2 way = directionAt(6.283185307179586 * i / rays);
        double near = 0, far = 0;
        bool found = false;
        for (int k = 1; k <= steps && !found; ++k) {
            near = far, far = parameters_.reach_m * k / steps;
            found = land_.water(p + way * far) != inWater;
        }
        for (int k = 0; k < 5 && found; ++k) {
            const double middle = (near + far) / 2;
            (land_.water(p + way * middle) != inWater ? far : near) = middle;
        }
        if (found) sum = sum - way * (1 - far / parameters_.reach_m);
    }
    // A straight bank at no distance gives rays / π.
    return sum * (3.14159265 / rays);
}

Vec2 TensorField::at(Vec2 p) const {
    const bool any = land_.grid || land_.rings || land_.shore || land_.contours;
    const auto weight = [&](const std::function<double(Vec2)>& w) { return w ? std::max(0.0, w(p)) : 0; };
    const double grid = any ? weight(land_.grid) : 1;
    Vec2 sum = tensorAlong(directionAt(parameters_.axis)) * grid;
    if (const double rings = weight(land_.rings); rings > 0) sum = sum + tensorAlong(unit(p - centre_)) * rings;
    if (const double shore = weight(land_.shore); shore > 0) {
        const Vec2 away = atMostOne(awayFromWater(p));
        sum = sum + tensorAlong(Vec2{-away.z, away.x}) * shore;
    }
    if (const double contours = weight(land_.contours); contours > 0 && land_.height) {
        // As strong as any where the ground is as steep as a road may be.
        const double h = parameters_.block_m / 4, steepest = std::max(1e-3, parameters_.slope);
        const Vec2 rise{(land_.height(p + Vec2{h, 0}) - land_.height(p - Vec2{h, 0})) / (2 * h * steepest),
                        (land_.height(p + Vec2{0, h}) - land_.height(p - Vec2{0, h})) / (2 * h * steepest)};
        const Vec2 strength = atMostOne(rise);
        sum = sum + tensorAlong(Vec2{-strength.z, strength.x}) * contours;
    }
    return sum;
}

Vec2 TensorField::nearest(Vec2 p, Vec2 heading) const {
    const Vec2 tensor = at(p);
    if (!(dot(tensor, tensor) > degenerate * degenerate)) return heading;
    const Vec2 major = majorOf(tensor);
    Vec2 found = major;
    for (const Vec2 d : {Vec2{-major.z, major.x}, major * -1, Vec2{major.z, -major.x}})
        if (dot(d, heading) > dot(found, heading)) found = d;
    return found;
}

Vec2 TensorField::direction(Vec2 from, Vec2 heading, double piece_m) const {
    const Vec2 first = nearest(from, heading);
    return nearest(from + first * (piece_m / 2), first);
}

}  // namespace sgm::town
