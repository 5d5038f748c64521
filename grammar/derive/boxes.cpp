#include "grammar/derive/boxes.h"

#include <cmath>

#include "grammar/derive/expressions.h"
#include "modeler/field/plan_solids.h"

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

double standsOut_m(const SolidValue& solid, double height_m) {
    const bool isOverPlan = solid.primitive && solid.primitive->plan != field::PlanUse::None;
    double out_m = isOverPlan ? field::standsOut_m(*solid.primitive, argumentNumbers(solid), height_m) : 0;
    for (const SolidValue& part : solid.parts) out_m = std::max(out_m, standsOut_m(part, height_m));
    return out_m;
}

namespace {

bool isUpright(const Scope& s) { return s.axes == Mat3{}; }

}  // namespace

Scope outerScope(const ShapeTree& tree, ShapeId shape) {
    Scope scope = tree.shapes[shape].scope;
    if (const SolidValue* solid = tree.solidOf(shape)) {
        const double out_m = standsOut_m(*solid, scope.size.y);
        scope.size.x += 2 * out_m;
        scope.size.z += 2 * out_m;
    }
    return scope;
}

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
        boxes.push_back({boxOf(outerScope(tree, s)), s});
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
