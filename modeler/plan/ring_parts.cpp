#include "modeler/plan/ring_parts.h"

#include <algorithm>

#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

constexpr double same_m = 1e-3;
/// How far off the corner of two moved lines may lie, in the larger of their distances.
constexpr double mitreLimit = 4;

/// At length 1; itself where its length is 0. Faster than std::hypot, and the same on every machine.
Vec2 unit(Vec2 v) {
    const double l = std::sqrt(dot(v, v));
    return l > 0 ? v * (1 / l) : v;
}

bool isSame(Vec2 d) { return dot(d, d) < same_m * same_m; }

Ring convexMovedIn(const Ring& outline, std::span<const double> distances_m) {
    Ring ring = outline;
    for (size_t i = 0; i < outline.size() && ring.size() >= 3; ++i) {
        const Vec2 d = unit(outline.to(i) - outline.from(i)), out{d.z, -d.x};
        ring = partBelow(ring, out, dot(out, outline.from(i)) - distances_m[i], outline.edges[i]);
    }
    return ring;
}

/// The corners of the moved lines; nothing where one is too far off.
std::optional<std::vector<Vec2>> movedCorners(const Ring& outline, std::span<const double> distances_m) {
    const size_t n = outline.size();
    std::vector<Vec2> corners;
    corners.reserve(n);
    Vec2 before = unit(outline.to(n - 1) - outline.from(n - 1));
    for (size_t i = 0; i < n; ++i) {
        const Vec2 own = unit(outline.to(i) - outline.from(i));
        const auto corner = cornerMovedIn(before, own, distances_m[i == 0 ? n - 1 : i - 1], distances_m[i]);
        if (!corner) return std::nullopt;
        corners.push_back(outline.from(i) + *corner);
        before = own;
    }
    return corners;
}

/// Whether every edge of the moved ring runs as it did, and none crosses another.
bool isSound(const Ring& moved, const Ring& outline) {
    for (size_t i = 0; i < moved.size(); ++i) {
        const Vec2 was = outline.to(i) - outline.from(i), is = moved.to(i) - moved.from(i);
        if (!(dot(was, is) > 0) || isSame(is)) return false;
    }
    return !firstFault(footprintOf({moved, {}}));
}

}  // namespace

bool isConvex(const Ring& ring) {
    for (size_t i = 0; i < ring.size(); ++i) {
        const size_t k = i + 1 == ring.size() ? 0 : i + 1;
        if (cross(ring.to(i) - ring.from(i), ring.to(k) - ring.from(k)) < 0) return false;
    }
    return true;
}

bool isCutOnce(const Ring& ring, Vec2 n, double at) {
    const double near = 2 * same_m * std::sqrt(dot(n, n));
    int changes = 0;
    bool wasOver = dot(n, ring.points.back()) > at;
    bool apart = true;
    for (const Vec2 p : ring.points) {
        const double over = dot(n, p) - at;
        apart = apart && std::abs(over) > near;
        changes += (over > 0) != wasOver;
        wasOver = over > 0;
    }
    return (apart && changes <= 2) || isConvex(ring);
}

Ring partBelow(const Ring& ring, Vec2 n, double at, Edge edge) {
    Ring out;
    out.points.reserve(ring.size() + 1), out.edges.reserve(ring.size() + 1);
    const auto add = [&](Vec2 p, Edge own) {
        if (!out.points.empty() && isSame(p - out.points.back()))
            out.edges.back() = own;
        else
            out.points.push_back(p), out.edges.push_back(own);
    };
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring.from(i), b = ring.to(i);
        const double u = dot(n, a) - at, v = dot(n, b) - at;
        if (u <= 0) add(a, ring.edges[i]);
        if ((u < 0 && v > 0) || (u > 0 && v < 0)) {
            const Vec2 p = a + (b - a) * (u / (u - v));
            add(p, u < 0 ? edge : ring.edges[i]);
        } else if (u == 0 && v > 0 && !out.edges.empty()) {
            out.edges.back() = edge;
        }
    }
    if (out.size() > 1 && isSame(out.points.front() - out.points.back())) out.points.pop_back(), out.edges.pop_back();
    return out;
}

std::optional<Vec2> cornerMovedIn(Vec2 along, Vec2 alongNext, double in_m, double inNext_m) {
    const Vec2 n{-along.z, along.x}, m{-alongNext.z, alongNext.x};  // into the solid
    const double most = mitreLimit * std::max(in_m, inNext_m);
    Vec2 p;
    if (in_m == inNext_m) {
        p = (n + m) * (in_m / std::max(1 + dot(n, m), 1e-9));
    } else {
        const double by = cross(n, m);
        if (std::abs(by) < 1e-9) return std::nullopt;
        p = {(in_m * m.z - inNext_m * n.z) / by, (inNext_m * n.x - in_m * m.x) / by};
    }
    if (dot(p, p) > most * most) return std::nullopt;
    return p;
}

std::optional<Ring> movedIn(const Ring& ring, std::span<const double> distances_m) {
    auto corners = movedCorners(ring, distances_m);
    if (!corners) return std::nullopt;
    if (isConvex(ring)) return convexMovedIn(ring, distances_m);
    Ring moved{std::move(*corners), ring.edges};
    if (!isSound(moved, ring)) return std::nullopt;
    return moved;
}

}  // namespace sgm::plan
