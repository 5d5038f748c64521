// Lines in the plane of a cell's face: where the fields of two pieces are zero together.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "modeler/mesh/piece_samples.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

constexpr float parallelSine = 1e-3f;  ///< sine of the least angle between two lines that cross

/// The two axes of a face.
struct FaceAxes {
    int u, v;
    explicit FaceAxes(int axis) : u((axis + 1) % 3), v((axis + 2) % 3) {}
    double dot(Vec3f g, Vec3f d) const { return double{g[u]} * d[u] + double{g[v]} * d[v]; }
    double length(Vec3f g) const { return std::sqrt(dot(g, g)); }
};

/// The rectangle of a face within its plane, metres.
struct FaceRectangle {
    FaceAxes axes;
    Vec3f low, high;

    FaceRectangle(const Grid& grid, Vec3i at, int axis)
        : axes(axis), low(grid.corner(at.x, at.y, at.z)), high(grid.corner(at.x + 1, at.y + 1, at.z + 1)) {}

    /// The nearest point that is so far from the sides.
    Vec3f within(Vec3f p, float margin_m) const {
        for (const int axis : {axes.u, axes.v})
            p[axis] = std::max(low[axis] + margin_m, std::min(high[axis] - margin_m, p[axis]));
        return p;
    }
    /// The nearest float beside the sides: far from the origin, rounding puts points onto them.
    Vec3f offSides(Vec3f p) const {
        for (const int axis : {axes.u, axes.v})
            p[axis] = std::clamp(p[axis], std::nextafter(low[axis], high[axis]), std::nextafter(high[axis], low[axis]));
        return p;
    }
};

/// A piece's field to first order: its value and derivative at a point.
struct LinearField {
    PiecePoint point;
    float value = 0;  ///< of the field at the point
};

/// Moves a point within the plane of the face to where its piece's field is zero; false where that is nowhere, since
/// the field doesn't change along the face.
inline bool moveInFace(const FaceAxes& plane, PiecePoint& point, float value) {
    const double square = plane.dot(point.gradient, point.gradient);
    if (!(square > 0)) return value == 0;
    for (const int axis : {plane.u, plane.v})
        point.at[axis] -= static_cast<float>(value * point.gradient[axis] / square);
    return true;
}

inline Vec3f between(Vec3f a, Vec3f b, double share) {
    return (a.as<double>() + (b - a).as<double>() * share).as<float>();
}

/// The nearest point at which a piece's field is zero.
inline PiecePoint onSurface(const LinearField& field) {
    PiecePoint point = field.point;
    const Vec3d g = point.gradient.as<double>();
    const double square = dot(g, g);
    if (square > 0) point.at = (point.at.as<double>() - g * (field.value / square)).as<float>();
    return point;
}

/// Moves `p` within the plane of the face to where both fields are zero; false, and `p` as it was, where their lines
/// are parallel. `p`'s coordinate across the plane becomes that of the face on which `a` lies.
inline bool crossInFace(const FaceAxes& plane, const LinearField& a, const LinearField& b, Vec3f& p) {
    const Vec3f ga = a.point.gradient, gb = b.point.gradient;
    const double det = double{ga[plane.u]} * gb[plane.v] - double{ga[plane.v]} * gb[plane.u];
    if (!(std::abs(det) > parallelSine * plane.length(ga) * plane.length(gb))) return false;
    // g · (p − q) + f = 0 for both.
    const double ra = plane.dot(ga, a.point.at) - a.value, rb = plane.dot(gb, b.point.at) - b.value;
    p = a.point.at;
    p[plane.u] = static_cast<float>((ra * gb[plane.v] - rb * ga[plane.v]) / det);
    p[plane.v] = static_cast<float>((rb * ga[plane.u] - ra * gb[plane.u]) / det);
    return true;
}

/// A point in the plane of a face, along its two axes.
struct FacePoint {
    double u = 0, v = 0;
    friend FacePoint operator-(FacePoint a, FacePoint b) { return {a.u - b.u, a.v - b.v}; }
};

/// Positive where `b` points to the left of `a`.
constexpr double turn(FacePoint a, FacePoint b) { return a.u * b.v - a.v * b.u; }

/// Whether a polyline turns to the left and to the right.
inline bool turnsBothWays(std::span<const FacePoint> points) {
    bool left = false, right = false;
    for (size_t i = 0; i + 2 < points.size(); ++i) {
        const double t = turn(points[i + 1] - points[i], points[i + 2] - points[i + 1]);
        left |= t > 0, right |= t < 0;
    }
    return left && right;
}

/// Whether a polyline neither meets nor touches itself. O(n²).
inline bool isSimple(std::span<const FacePoint> points) {
    // Of the line through a and b.
    const auto areOnOneSide = [&](FacePoint a, FacePoint b, FacePoint p, FacePoint q) {
        return turn(b - a, p - a) * turn(b - a, q - a) > 0;
    };
    for (size_t i = 0; i + 2 < points.size(); ++i) {
        const FacePoint before = points[i + 1] - points[i], after = points[i + 2] - points[i + 1];
        if (turn(before, after) == 0 && before.u * after.u + before.v * after.v <= 0) return false;
        for (size_t k = i + 2; k + 1 < points.size(); ++k)
            if (!areOnOneSide(points[i], points[i + 1], points[k], points[k + 1]) &&
                !areOnOneSide(points[k], points[k + 1], points[i], points[i + 1]))
                return false;
    }
    return true;
}

}  // namespace sgm::mesh
