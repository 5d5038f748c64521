// Polygons of few vertices to triangles by cutting ears, with exact predicates.
#include <algorithm>

#include "modeler/mesh/plane_points.h"

namespace sgm::mesh {
namespace {

using Points = std::vector<PlanePoint>;

/// 1 where a, b, c turn left.
int turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return static_cast<int>(CGAL::orientation(a, b, c));
}

bool boxesMeet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, const PlanePoint& d) {
    return std::max(a.x(), b.x()) >= std::min(c.x(), d.x()) && std::max(c.x(), d.x()) >= std::min(a.x(), b.x()) &&
           std::max(a.y(), b.y()) >= std::min(c.y(), d.y()) && std::max(c.y(), d.y()) >= std::min(a.y(), b.y());
}

/// Whether two segments have a point in common.
bool segmentsMeet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, const PlanePoint& d) {
    if (!boxesMeet(a, b, c, d)) return false;
    return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
}

/// Whether edges of the polygon meet elsewhere than in common ends.
bool touchesItself(const Points& p) {
    const size_t n = p.size();
    for (size_t i = 0; i < n; ++i) {
        const PlanePoint &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
        if (a == b) return true;
        if (turn(a, b, c) == 0 && (b - a) * (c - b) < 0) return true;
        for (size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j == n - 1) continue;
            if (segmentsMeet(a, b, p[j], p[(j + 1) % n])) return true;
        }
    }
    return false;
}

double doubleArea(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// How far a triangle is from a needle: its area by the square of its longest side.
double shape(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    const double longest = std::max({(b - a).squared_length(), (c - b).squared_length(), (a - c).squared_length()});
    return doubleArea(a, b, c) / longest;
}

class EarCutter {
public:
    explicit EarCutter(const Points& points) : points_(points), left_(points.size()) {
        for (uint32_t i = 0; i < points.size(); ++i) left_[i] = i;
        for (uint32_t i = 0; i < points.size(); ++i) shapes_.push_back(earShape(i));
    }
    /// The next best ear, as places in the polygon; false where there is none.
    bool cut(std::array<uint32_t, 3>& ear) {
        const size_t best = static_cast<size_t>(std::max_element(shapes_.begin(), shapes_.end()) - shapes_.begin());
        if (!(shapes_[best] > notAnEar)) return false;
        ear = {at(best + left_.size() - 1), at(best), at(best + 1)};
        left_.erase(left_.begin() + static_cast<ptrdiff_t>(best));
        shapes_.erase(shapes_.begin() + static_cast<ptrdiff_t>(best));
        // A cut may free ears anywhere that it was inside of, but it can't spoil any but its neighbours'.
        for (size_t i = 0; i < left_.size(); ++i) {
            const bool beside = i == best % left_.size() || i == (best + left_.size() - 1) % left_.size();
            if (beside || shapes_[i] == notAnEar) shapes_[i] = earShape(i);
        }
        return true;
    }

private:
    static constexpr double notAnEar = -1;
    uint32_t at(size_t i) const { return left_[i % left_.size()]; }

    /// The shape of the triangle at a corner, or notAnEar.
    double earShape(size_t i) const {
        const uint32_t before = at(i + left_.size() - 1), here = at(i), after = at(i + 1);
        const PlanePoint &a = points_[before], &b = points_[here], &c = points_[after];
        if (turn(a, b, c) <= 0) return notAnEar;
        for (const uint32_t other : left_) {
            if (other == before || other == here || other == after) continue;
            const PlanePoint& p = points_[other];
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return notAnEar;
        }
        return std::max(shape(a, b, c), 0.0);
    }

    const Points& points_;
    std::vector<uint32_t> left_;
    std::vector<double> shapes_;
};

}  // namespace

bool cutEars(std::span<const uint32_t> loop, std::span<const Vec3f> positions, const PlaneProjection& project,
             std::vector<Triangle>& triangles) {
    Points points;
    points.reserve(loop.size());
    for (const uint32_t v : loop) points.push_back(project(positions[v]));
    if (loop.size() == 3) {
        if (turn(points[0], points[1], points[2]) <= 0) return false;
        triangles.push_back({loop[0], loop[1], loop[2]});
        return true;
    }
    if (touchesItself(points)) return false;
    double area = 0;
    for (size_t i = 1; i + 1 < points.size(); ++i) area += doubleArea(points[0], points[i], points[i + 1]);
    if (!(area > 0)) return false;
    const size_t before = triangles.size();
    EarCutter cutter(points);
    for (size_t i = 0; i + 2 < loop.size(); ++i) {
        std::array<uint32_t, 3> ear;
        if (!cutter.cut(ear)) {
            triangles.resize(before);
            return false;
        }
        triangles.push_back({loop[ear[0]], loop[ear[1]], loop[ear[2]]});
    }
    return true;
}

}  // namespace sgm::mesh
