#include "modeler/mesh/small_polygon.h"

#include <algorithm>
#include <limits>

namespace sgm::mesh {
namespace {

constexpr double leastAlong = 0.8;  ///< cosine between a triangle and the polygon's normal

double square(Vec3d v) { return dot(v, v); }

/// Twice the area of a triangle as far as it faces along unit `n`.
double facing(Vec3d a, Vec3d b, Vec3d c, Vec3d n) { return dot(cross(b - a, c - a), n); }

}  // namespace

Vec3d SmallPolygon::doubleArea() const {
    Vec3d sum{};
    for (size_t i = 1; i + 1 < points_.size(); ++i) sum += cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
    return sum;
}

/// How far a triangle is from a needle, seen along the normal; at most 0 where it faces away.
double SmallPolygon::shapeOf(size_t a, size_t b, size_t c) const {
    const Vec3d p = points_[a], q = points_[b], r = points_[c];
    return facing(p, q, r, normal_) / (square(q - p) + square(r - q) + square(p - r));
}

/// Whether a triangle holds no other corner of the ring.
bool SmallPolygon::isEar(size_t before, size_t at, size_t after) const {
    const Vec3d a = points_[before], b = points_[at], c = points_[after];
    return std::none_of(ring_.begin(), ring_.end(), [&](size_t other) {
        const Vec3d p = points_[other];
        return other != before && other != at && other != after && facing(a, b, p, normal_) >= 0 &&
               facing(b, c, p, normal_) >= 0 && facing(c, a, p, normal_) >= 0;
    });
}

void SmallPolygon::beginRing() {
    ring_.resize(points_.size());
    for (size_t i = 0; i < ring_.size(); ++i) ring_[i] = i;
}

/// Whether a triangle stands steep on the polygon.
bool SmallPolygon::turnsMuch() const {
    return std::any_of(triangles_.begin(), triangles_.end(), [&](const auto& t) {
        const Vec3d across = cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
        return dot(across, normal_) < leastAlong * length(across);
    });
}

/// The best triangle at the diagonal between two corners, from those of the smaller parts (Klincsek, "Minimal
/// triangulations of polygonal domains", 1980).
void SmallPolygon::findApex(size_t i, size_t j, bool isAllowed) {
    worst_[i][j] = j == i + 1 ? std::numeric_limits<double>::infinity() : 0;
    if (!isAllowed) return;
    for (size_t k = i + 1; k < j; ++k) {
        const double parts = std::min(worst_[i][k], worst_[k][j]);
        if (!(parts > worst_[i][j])) continue;
        const double least = std::min(parts, shapeOf(i, k, j));
        if (least > worst_[i][j]) worst_[i][j] = least, apex_[i][j] = k;
    }
}

/// Takes the triangles of the best triangulation. All of them face along the normal, so they don't overlap.
void SmallPolygon::takeBest() {
    if (!(worst_[0][ring_.size() - 1] > 0)) return;
    triangles_.clear();
    parts_.assign(1, {0, ring_.size() - 1});
    while (!parts_.empty()) {
        const auto [i, j] = parts_.back();
        parts_.pop_back();
        if (j == i + 1) continue;
        const size_t k = apex_[i][j];
        triangles_.push_back({i, k, j});
        parts_.push_back({k, j}), parts_.push_back({i, k});
    }
}

}  // namespace sgm::mesh
