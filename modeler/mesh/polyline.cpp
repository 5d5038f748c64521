#include "modeler/mesh/polyline.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// The point between two that is farthest from the segment that joins them; indices run on past the end of a closed
/// one.
struct Farthest {
    size_t index = 0;
    double squared = -1;
};

Farthest farthest(std::span<const Vec3f> points, size_t from, size_t to) {
    const Vec3d a = points[from % points.size()].as<double>(), b = points[to % points.size()].as<double>();
    Farthest found;
    for (size_t i = from + 1; i < to; ++i) {
        const double d = squaredDistance(points[i % points.size()].as<double>(), a, b);
        if (d > found.squared) found = {i, d};
    }
    return found;
}

/// Splits at the farthest point until none is farther than the bound.
void split(std::span<const Vec3f> points, size_t from, size_t to, double bound_m, std::vector<bool>& keep) {
    std::vector<std::pair<size_t, size_t>> open{{from, to}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        const Farthest f = farthest(points, a, b);
        if (!(f.squared > bound_m * bound_m)) continue;
        keep[f.index % points.size()] = true;
        open.push_back({a, f.index});
        open.push_back({f.index, b});
    }
}

size_t farthestFrom(std::span<const Vec3f> points, size_t from) {
    size_t found = from;
    double most = -1;
    for (size_t i = 0; i < points.size(); ++i) {
        const Vec3d d = (points[i] - points[from]).as<double>();
        if (dot(d, d) > most) most = dot(d, d), found = i;
    }
    return found;
}

}  // namespace

double squaredDistance(Vec3d p, Vec3d a, Vec3d b) {
    const Vec3d ab = b - a, ap = p - a;
    const double along = dot(ab, ab);
    const double t = along > 0 ? std::clamp(dot(ap, ab) / along, 0.0, 1.0) : 0.0;
    const Vec3d off = ap - ab * t;
    return dot(off, off);
}

void simplifyPolyline(std::span<const Vec3f> points, bool closed, double bound_m, std::vector<bool>& keep) {
    const size_t n = points.size();
    if (n == 0) return;
    if (!closed) {
        keep[0] = keep[n - 1] = true;
    } else {  // the farthest point from any other is a corner of the convex hull
        const size_t first = farthestFrom(points, 0), second = farthestFrom(points, first);
        keep[first] = keep[second] = true;
    }
    std::vector<size_t> fixed;
    for (size_t i = 0; i < n; ++i)
        if (keep[i]) fixed.push_back(i);
    for (size_t i = 0; i + 1 < fixed.size(); ++i) split(points, fixed[i], fixed[i + 1], bound_m, keep);
    if (!closed) return;
    split(points, fixed.back(), fixed.front() + n, bound_m, keep);
    if (std::count(keep.begin(), keep.end(), true) > 2) return;
    const Farthest one = farthest(points, fixed.front(), fixed.back()),
                   other = farthest(points, fixed.back(), fixed.front() + n);
    keep[(one.squared >= other.squared ? one.index : other.index) % n] = true;
}

}  // namespace sgm::mesh
