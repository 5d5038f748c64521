#include "modeler/plan/cut.h"

#include <algorithm>
#include <optional>

#include "modeler/plan/edit.h"
#include "modeler/plan/ring_parts.h"

namespace sgm::plan {
namespace {

double coordinate(Vec2 p, int axis) { return axis == 0 ? p.x : p.z; }

/// The part below a coordinate.
Footprint below(const Footprint& footprint, int axis, double at) {
    return clipped(footprint, {axis == 0 ? Vec2{1, 0} : Vec2{0, 1}, at});
}

/// The coordinate below which `wanted` of the area lies, by bisection over the area's own measure.
double coordinateOfArea(const Footprint& footprint, int axis, double wanted) {
    const Box2 box = bounds(footprint);
    double lo = coordinate(box.lo, axis), hi = coordinate(box.hi, axis);
    for (int step = 0; step < 60 && hi - lo > 1e-9; ++step) {
        const double middle = (lo + hi) / 2;
        (area(below(footprint, axis, middle)) < wanted ? lo : hi) = middle;
    }
    return hi;
}

/// Of one polygon that the line cuts into two at most.
std::optional<Footprint> clippedOnce(const Footprint& footprint, const HalfPlane& keep) {
    constexpr double leastArea_m2 = 1e-5;
    if (footprint.polygons.size() != 1 || !footprint.polygons[0].courts.empty()) return std::nullopt;
    const Ring& outline = footprint.polygons[0].outer;
    if (!isCutOnce(outline, keep.normal, keep.offset)) return std::nullopt;
    Ring ring = partBelow(outline, keep.normal, keep.offset);
    Footprint part{{}, footprint.tags};
    if (ring.size() >= 3 && signedArea(ring) > leastArea_m2) part.polygons.push_back({std::move(ring), {}});
    return part;
}

}  // namespace

Footprint clipped(const Footprint& footprint, const HalfPlane& keep) {
    const double l = length(keep.normal);
    const Box2 box = bounds(footprint);
    if (footprint.empty() || !(l > 0)) return footprint;
    if (auto part = clippedOnce(footprint, keep)) return std::move(*part);
    const Vec2 n = keep.normal * (1 / l), along{-n.z, n.x};
    // A rectangle that holds all of the footprint on the near side of the line.
    const double reach = length(box.size()) + 1;
    const double at = keep.offset / l, middle = dot(box.centre(), n);
    if (at - middle > reach) return footprint;
    if (at - middle < -reach) return {{}, footprint.tags};
    const Vec2 on = box.centre() + n * (at - middle), side = along * (2 * reach), back = n * (-4 * reach);
    return boolean(Boolean::Intersection, footprint,
                   footprintOf(polygonOf({on + side, on - side, on - side + back, on + side + back})));
}

Footprint between(const Footprint& footprint, int axis, double from_m, double to_m) {
    return clipped(below(footprint, axis, to_m), {axis == 0 ? Vec2{-1, 0} : Vec2{0, -1}, -from_m});
}

std::vector<Footprint> splitByArea(const Footprint& footprint, int axis, std::span<const double> areas_m2) {
    std::vector<Footprint> parts;
    Footprint rest = footprint;
    for (const double wanted : areas_m2) {
        const double whole = area(rest);
        if (!(wanted > 0)) {
            parts.push_back({{}, footprint.tags});
        } else if (wanted >= whole) {
            parts.push_back(std::move(rest));
            rest = {{}, footprint.tags};
        } else {
            const double at = coordinateOfArea(rest, axis, wanted);
            parts.push_back(below(rest, axis, at));
            rest = clipped(rest, {axis == 0 ? Vec2{-1, 0} : Vec2{0, -1}, -at});
        }
    }
    parts.push_back(std::move(rest));
    return parts;
}

}  // namespace sgm::plan
