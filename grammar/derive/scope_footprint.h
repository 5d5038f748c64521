// The plan that a scope stands for.
// Enters: a scope and the footprints of its tree. Leaves: a polygon. Assumes that the scope's index is of that table.
#pragma once

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

/// The footprint of a scope in metres about its centre; its rectangle where it has none. O(edges).
inline plan::Footprint footprintOf(const Scope& scope, const Footprints& footprints) {
    const Vec3d h = scope.half();
    if (scope.footprint != none) return footprints.inMetres(scope.footprint, h);
    return plan::footprintOf(plan::polygonOf({{-h.x, -h.z}, {h.x, -h.z}, {h.x, h.z}, {-h.x, h.z}}));
}

/// A footprint that is in metres about the centre of a scope, in the plan (x, z) of the model. O(edges).
inline plan::Footprint inModelPlan(const Scope& scope, plan::Footprint footprint) {
    const auto place = [&](plan::Ring& ring) {
        for (plan::Vec2& p : ring.points) {
            const Vec3d at = scope.centre + scope.axes * Vec3d{p.x, 0, p.z};
            p = {at.x, at.z};
        }
    };
    for (plan::Polygon& polygon : footprint.polygons) {
        place(polygon.outer);
        for (plan::Ring& court : polygon.courts) place(court);
    }
    return footprint;
}

}  // namespace sgm::derive
