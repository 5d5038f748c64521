#include "modeler/town/point.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

int64_t crossOf(Point a, Point b, Point c) {
    return (int64_t{b.x} - a.x) * (int64_t{c.z} - a.z) - (int64_t{b.z} - a.z) * (int64_t{c.x} - a.x);
}
int signOf(int64_t v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

}  // namespace

Point pointAt(Vec2 p) {
    const auto nearest = [](double m) {
        return static_cast<int32_t>(std::floor(std::clamp(m, -farthest_m, farthest_m) * 1000 + .5));
    };
    return {nearest(p.x), nearest(p.z)};
}

int turnOf(Point a, Point b, Point c) { return signOf(crossOf(a, b, c)); }

bool isOnSegment(Point a, Point b, Point p) {
    return turnOf(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
           std::min(a.z, b.z) <= p.z && p.z <= std::max(a.z, b.z);
}

bool segmentsMeet(Point a, Point b, Point c, Point d) {
    const int abc = turnOf(a, b, c), abd = turnOf(a, b, d), cda = turnOf(c, d, a), cdb = turnOf(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return isOnSegment(a, b, c) || isOnSegment(a, b, d) || isOnSegment(c, d, a) || isOnSegment(c, d, b);
}

Vec2 unit(Vec2 v) {
    const double l = lengthOf(v);
    return l > 0 ? v * (1 / l) : v;
}

Vec2 directionAt(double angle) {
    // angle = n·π/2 + r, |r| ≤ π/4; Taylor to r¹⁵ and r¹⁴.
    constexpr double quarter = 1.5707963267948966;
    const double n = std::floor(angle / quarter + .5), r = angle - n * quarter, s = r * r;
    double sine = 1, cosine = 1;
    for (int k = 14; k >= 2; k -= 2) {
        sine = 1 - s / (k * (k + 1)) * sine;
        cosine = 1 - s / (k * (k - 1)) * cosine;
    }
    sine *= r;
    const int turns = static_cast<int>(n - 4 * std::floor(n / 4));
    const Vec2 d = turns == 0   ? Vec2{cosine, sine}
                   : turns == 1 ? Vec2{-sine, cosine}
                   : turns == 2 ? Vec2{-cosine, -sine}
                                : Vec2{sine, -cosine};
    return unit(d);
}

}  // namespace sgm::town
