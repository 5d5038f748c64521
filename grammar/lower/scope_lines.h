// Lines through a scope, along which thin parts are looked for.
// Enters: a scope. Leaves: where the lines pass. Assumes nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grammar/derive/shape_tree.h"
#include "modeler/field/convex.h"

namespace sgm::lower {

inline constexpr int fewestLines = 4, mostLines = 16;  ///< along an axis across the thin one
inline constexpr double lineReach = 1.02;              ///< of a scope's half extent, so that its own faces are crossed

/// Whether a solid's faces are those of its scope.
inline bool isBox(const derive::SolidValue& solid, const derive::Scope& scope) {
    return solid.primitive && solid.primitive->convexParts == field::convex::cube &&
           (solid.primitive->plan == field::PlanUse::None || scope.footprint == derive::none);
}

inline Vec3d alongAxis(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

/// Cells up to this size, times the thickness, hold a wall across a unit direction, however that lies: along the
/// world's axes a sample lies in whatever is as thick as a cell.
inline double turnOf(Vec3d across) { return 1 / (std::abs(across.x) + std::abs(across.y) + std::abs(across.z)); }

/// The same for a plate across an axis of the scope.
inline double turnOf(const derive::Scope& scope, int axis) { return turnOf(scope.axes * alongAxis(axis)); }

/// The largest cells that hold a thin scope.
inline double cellThatHolds(const derive::Scope& scope) {
    const double least = minComponent(scope.size);
    double turn = 1;
    for (int axis = 0; axis < 3; ++axis)
        if (scope.size[axis] <= 1.01 * least) turn = std::min(turn, turnOf(scope, axis));
    return least * turn;
}

/// Where the i-th of n lines passes a half extent: denser towards the ends, for a bar may run through a house and show
/// these alone; off the middle, so that no line lies in a plane of symmetry.
inline double shareOf(int i, int n) { return -std::cos(std::numbers::pi * (i + 0.535) / n); }

/// Whether eachLine has lines along an axis of the scope: it is thin there.
inline bool isThinAlong(const derive::Scope& scope, int axis, double cell_m) {
    return scope.size[axis] < cell_m || scope.size[axis] == minComponent(scope.size);
}

/// Calls visit(share, axis) for each line through the scope along its thin axes until one call returns false; whether
/// none did. `share` is where the line passes, in half extents, 0 along the axis.
template <class Visit>
bool eachLine(const derive::Scope& scope, double cell_m, Visit&& visit) {
    const auto linesAlong = [&](int across) {
        return static_cast<int>(
            std::clamp(std::ceil(scope.size[across] / cell_m), double{fewestLines}, double{mostLines}));
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (!isThinAlong(scope, axis, cell_m)) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3, alongU = linesAlong(u), alongV = linesAlong(v);
        for (int j = 0; j < alongV; ++j)
            for (int i = 0; i < alongU; ++i) {
                Vec3d share{};
                share[u] = shareOf(i, alongU), share[v] = shareOf(j, alongV);
                if (!visit(share, axis)) return false;
            }
    }
    return true;
}

}  // namespace sgm::lower
