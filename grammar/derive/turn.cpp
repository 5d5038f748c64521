#include "grammar/derive/turn.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "grammar/derive/scope_footprint.h"
#include "modeler/core/conventions.h"

namespace sgm::derive {
namespace {

constexpr double quarter = pi / 2;
constexpr double sameDirection = 1e-6;  ///< radians
constexpr double upright = 1 - 1e-9;

/// Walls that face one of four directions.
struct Facing {
    double angle;  ///< radians, from 0 to below π/2
    double area_m2;
};

/// Of the directions of a vector of the plan and its quarter turns.
double angleOf(Vec3d direction) {
    const double angle = std::fmod(std::atan2(-direction.z, direction.x) + 2 * pi, quarter);
    return quarter - angle < sameDirection ? angle - quarter : angle;  // those about 0 are together
}

std::vector<Facing> facingsOf(const ShapeTree& tree) {
    std::vector<Facing> facings;
    const auto add = [&](double angle, double area_m2) {
        if (!facings.empty() && facings.back().angle == angle)
            facings.back().area_m2 += area_m2;
        else
            facings.push_back({angle, area_m2});
    };
    for (ShapeId id = 0; id < tree.shapes.size(); ++id) {
        if (tree.shapes.record(id).solid == none) continue;
        const Scope scope = tree.shapes.scopeOf(id);
        if (std::abs(scope.axes.y.y) < upright) continue;
        if (scope.footprint == none) {
            add(angleOf(scope.axes.x), 2 * (scope.size.x + scope.size.z) * scope.size.y);
            continue;
        }
        for (const plan::PlacedEdge& edge : plan::edgesOf(footprintOf(scope, tree.footprints))) {
            const plan::Vec2 out = edge.normal();
            add(angleOf(scope.axes * Vec3d{out.x, 0, out.z}), edge.length() * scope.size.y);
        }
    }
    return facings;
}

double snapped(double component) {
    constexpr double rounding = 1e-12;
    const double whole = std::round(component);
    return std::abs(component - whole) < rounding ? whole : component;
}

Vec3d snapped(Vec3d axis) { return {snapped(axis.x), snapped(axis.y), snapped(axis.z)}; }

/// Rotates scopes.
class Turn {
public:
    explicit Turn(double angle) : rotation_(Mat3::rotation({0, 1, 0}, angle)) {}

    Mat3 operator()(const Mat3& axes) const {
        const Mat3 turned = rotation_ * axes;
        return {snapped(turned.x), snapped(turned.y), snapped(turned.z)};
    }
    Vec3d operator()(Vec3d place) const {
        constexpr double step_m = 0x1p-32;  // far less than what fields tell apart
        const Vec3d turned = rotation_ * place;
        return {std::round(turned.x / step_m) * step_m, place.y, std::round(turned.z / step_m) * step_m};
    }
    Scope operator()(Scope scope) const {
        scope.centre = (*this)(scope.centre);
        scope.axes = (*this)(scope.axes);
        return scope;
    }

private:
    Mat3 rotation_;
};

}  // namespace

double facingOf(const Derivation& derivation) {
    std::vector<Facing> facings = facingsOf(derivation.tree);
    std::sort(facings.begin(), facings.end(), [](const Facing& a, const Facing& b) { return a.angle < b.angle; });
    double all_m2 = 0, most_m2 = 0, best = 0;
    for (size_t first = 0, end = 0; first < facings.size(); first = end) {
        double area_m2 = 0;
        size_t largest = first;
        for (; end < facings.size() && (end == first || facings[end].angle - facings[end - 1].angle < sameDirection);
             ++end) {
            area_m2 += facings[end].area_m2;
            if (facings[end].area_m2 > facings[largest].area_m2) largest = end;
        }
        all_m2 += area_m2;
        if (area_m2 > most_m2) most_m2 = area_m2, best = facings[largest].angle;
    }
    if (most_m2 <= all_m2 / 2 || std::abs(best) < sameDirection) return 0;
    return best > quarter / 2 ? best - quarter : best;
}

Derivation turned(const Derivation& derivation, double angle) {
    const Turn turn(angle);
    Derivation made = derivation;
    ShapeTree& tree = made.tree;
    for (ShapeId id = 0; id < tree.shapes.size(); ++id) tree.shapes.setScope(id, turn(tree.shapes.scopeOf(id)));
    for (Extras& extras : tree.extras) {
        if (extras.laidScope) extras.laidScope = turn(*extras.laidScope);
        for (Displacement& noise : extras.displace) noise.frame = {turn(noise.frame.origin), turn(noise.frame.axes)};
    }
    return made;
}

}  // namespace sgm::derive
