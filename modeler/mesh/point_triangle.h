// How far a point is from a triangle.
// Enters: points. Leaves: squares of distances. Assumes finite coordinates; a triangle may be a segment or a point.
#pragma once

#include <algorithm>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// Square of the distance from p to the triangle a b c, in the square of their unit (Ericson, "Real-Time Collision
/// Detection", 2005, 5.1.5).
inline float squaredDistance(Vec3f p, Vec3f a, Vec3f b, Vec3f c) {
    const Vec3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const auto off = [&](Vec3f q) { return dot(p - q, p - q); };
    const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return off(a);
    if (d3 >= 0 && d4 <= d3) return off(b);
    if (d6 >= 0 && d5 <= d6) return off(c);
    const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return off(a + ab * (d1 / (d1 - d3)));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return off(a + ac * (d2 / (d2 - d6)));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return off(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const float sum = va + vb + vc;
    return sum > 0 ? off(a + ab * (vb / sum) + ac * (vc / sum)) : std::min({off(a), off(b), off(c)});
}

}  // namespace sgm::mesh
