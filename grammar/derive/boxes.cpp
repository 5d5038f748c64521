#include "grammar/derive/boxes.h"

#include <cmath>

namespace sgm::derive {

double reach(const Scope& s, Vec3d axis) {
    const Vec3d h = s.half();
    return std::abs(dot(s.axes.x, axis)) * h.x + std::abs(dot(s.axes.y, axis)) * h.y +
           std::abs(dot(s.axes.z, axis)) * h.z;
}

Box3d boxOf(const Scope& s, double share) {
    const Vec3d r = Vec3d{reach(s, {1, 0, 0}), reach(s, {0, 1, 0}), reach(s, {0, 0, 1})} * share;
    return {s.centre - r, s.centre + r};
}

namespace {

bool isUpright(const Scope& s) { return s.axes == Mat3{}; }

}  // namespace

double penetration(const Scope& a, const Scope& b) {
    const Vec3d gap = b.centre - a.centre;
    double least = 1e300;
    const auto along = [&](Vec3d axis) {
        const double l = length(axis);
        if (l < 1e-6) return;
        axis = axis / l;
        least = std::min(least, reach(a, axis) + reach(b, axis) - std::abs(dot(gap, axis)));
    };
    const Vec3d axesA[3] = {a.axes.x, a.axes.y, a.axes.z}, axesB[3] = {b.axes.x, b.axes.y, b.axes.z};
    for (int i = 0; i < 3; ++i) along(axesA[i]);
    if (isUpright(a) && isUpright(b)) return least;
    for (int i = 0; i < 3; ++i) along(axesB[i]);
    for (const Vec3d& u : axesA)
        for (const Vec3d& v : axesB) along(cross(u, v));
    return least;
}

std::vector<Boxed> solidsInOrder(const ShapeTree& tree, int& axis) {
    std::vector<Boxed> boxes;
    Box3d all;
    Vec3d sizes;
    for (ShapeId s = 0; s < tree.shapes.size(); ++s) {
        if (tree.shapes[s].solid == none) continue;
        boxes.push_back({boxOf(tree.shapes[s].scope), s});
        all = hull(all, boxes.back().box);
        sizes += boxes.back().box.size();
    }
    axis = 0;
    for (int i = 1; i < 3; ++i)
        if (all.size()[i] * sizes[axis] > all.size()[axis] * sizes[i]) axis = i;
    std::sort(boxes.begin(), boxes.end(), [&](const Boxed& a, const Boxed& b) {
        return a.box.lo[axis] != b.box.lo[axis] ? a.box.lo[axis] < b.box.lo[axis] : a.shape < b.shape;
    });
    return boxes;
}

}  // namespace sgm::derive
