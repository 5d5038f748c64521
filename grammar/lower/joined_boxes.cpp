#include "grammar/lower/joined_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace sgm::lower {
namespace {

constexpr double unit_m = 1e-6;  ///< within which two numbers are one

/// A box by its ends along the axes of all.
struct Extents {
    size_t first;
    uint32_t look;
    Vec3d lo, hi;
    std::array<int64_t, 3> from, to;  ///< the same in units
    bool isJoined = false;
};

std::array<int64_t, 3> inUnits(Vec3d p) {
    return {std::llround(p.x / unit_m), std::llround(p.y / unit_m), std::llround(p.z / unit_m)};
}

/// Joins neighbours along one axis. Whether there were any.
bool joinAlong(size_t axis, std::vector<Extents>& boxes) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto row = [&](const Extents& b) { return std::tuple(b.look, b.from[u], b.to[u], b.from[v], b.to[v]); };
    std::sort(boxes.begin(), boxes.end(), [&](const Extents& a, const Extents& b) {
        return std::tuple(row(a), a.from[axis], a.first) < std::tuple(row(b), b.from[axis], b.first);
    });
    size_t kept = 0;
    for (size_t i = 1; i < boxes.size(); ++i) {
        Extents& last = boxes[kept];
        if (row(last) == row(boxes[i]) && last.to[axis] == boxes[i].from[axis]) {
            last.first = std::min(last.first, boxes[i].first);
            last.hi[static_cast<int>(axis)] = boxes[i].hi[static_cast<int>(axis)], last.to[axis] = boxes[i].to[axis];
            last.isJoined = true;
        } else {
            boxes[++kept] = boxes[i];
        }
    }
    const bool some = kept + 1 < boxes.size();
    boxes.resize(kept + 1);
    return some;
}

}  // namespace

std::vector<JoinedBox> joinBoxes(std::span<const derive::Scope> scopes, std::span<const uint32_t> looks) {
    std::vector<JoinedBox> joined;
    if (scopes.empty()) return joined;
    const Mat3 axes = scopes[0].axes, toLocal = axes.transposed();
    std::vector<Extents> boxes;
    for (size_t i = 0; i < scopes.size(); ++i) {
        const Vec3d centre = toLocal * scopes[i].centre, lo = centre - scopes[i].half(), hi = centre + scopes[i].half();
        boxes.push_back({i, looks[i], lo, hi, inUnits(lo), inUnits(hi)});
    }
    for (size_t axis = 0, vain = 0; vain < 3; axis = (axis + 1) % 3) vain = joinAlong(axis, boxes) ? 0 : vain + 1;
    std::sort(boxes.begin(), boxes.end(), [](const Extents& a, const Extents& b) { return a.first < b.first; });
    for (const Extents& box : boxes) {
        derive::Scope scope = scopes[box.first];
        if (box.isJoined) scope.centre = axes * ((box.lo + box.hi) * 0.5), scope.size = box.hi - box.lo;
        joined.push_back({box.first, scope});
    }
    return joined;
}

}  // namespace sgm::lower
