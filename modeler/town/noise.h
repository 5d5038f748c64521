// Smooth noise over the plan.
// Enters: a place. Leaves: a number, the same on every machine. Assumes coordinates within 10⁹ of the noise's size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "modeler/core/random.h"
#include "modeler/plan/polygon.h"

namespace sgm::town {

/// Value noise, −1 … 1, one number a unit of `p` (K. Perlin's interpolation of 2002).
inline double valueNoise(plan::Vec2 p, uint64_t seed) {
    const double x = std::floor(p.x), z = std::floor(p.z), u = p.x - x, v = p.z - z;
    const auto corner = [&](double i, double k) {
        const auto key = [](double c) { return static_cast<uint64_t>(static_cast<int64_t>(c)); };
        return uniform(combine(combine(seed, key(x + i)), key(z + k)), -1, 1);
    };
    const auto ease = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double s = ease(u), t = ease(v);
    const double low = corner(0, 0) * (1 - s) + corner(1, 0) * s, high = corner(0, 1) * (1 - s) + corner(1, 1) * s;
    return low * (1 - t) + high * t;
}

/// `octaves` of it, each half as large and half as strong; −1 … 1.
inline double fbmNoise(plan::Vec2 p, double size_m, int octaves, uint64_t seed) {
    double sum = 0, weight = 1, whole = 0;
    for (int i = 0; i < std::clamp(octaves, 1, 12); ++i, weight /= 2, size_m /= 2) {
        sum += weight * valueNoise(p * (1 / size_m), seed + static_cast<uint64_t>(i));
        whole += weight;
    }
    return sum / whole;
}

/// 1 at `centre`, falling to 0 at `radius_m` and beyond, smooth at both ends.
inline double bump(plan::Vec2 p, plan::Vec2 centre, double radius_m) {
    const plan::Vec2 d = p - centre;
    const double t = radius_m > 0 ? 1 - plan::dot(d, d) / (radius_m * radius_m) : 0;
    return t > 0 ? t * t : 0;
}

}  // namespace sgm::town
