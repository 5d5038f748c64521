// Where a face of a scope is looked at: a grid of points, even along both sides where it would have too many.
// Enters: a scope, the two axes in the face, the edge of a mesh's cells. Leaves: how many points, and where.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "grammar/derive/shapes.h"
#include "grammar/lower/scope_lines.h"

namespace sgm::lower {

/// Points of a face that are looked at: at most `mostAlong` along its longer side, and about `most` in all.
struct FacePoints {
    int mostAlong, most;
    double apart = 1;          ///< of half a cell, or of the scope's thickness where that is less
    bool nearBorders = false;  ///< the first and last ones are `borderShare` of the face from its borders

    /// Less than what counts as missing: no wider strip along a border stays unseen.
    static constexpr double borderShare = 0.0025;

    /// How many points stand along the axes `u` and `v` in the face; `cell_m` is the edge of the mesh's cells, metres.
    std::array<int, 2> counts(const derive::Scope& scope, int u, int v, double cell_m) const {
        const double apart_m =
            apart * std::min(0.5 * cell_m, minComponent(scope.size));  // what crosses a bar is as wide
        const auto along = [&](int axis, int limit) {
            const double wanted = std::ceil(scope.size[axis] / apart_m);
            return static_cast<int>(std::clamp(wanted, double{fewestLines}, static_cast<double>(limit)));
        };
        const bool uIsLong = scope.size[u] > scope.size[v];
        const int longAxis = uIsLong ? u : v, shortAxis = uIsLong ? v : u;
        const auto evenly = static_cast<int>(std::sqrt(most * scope.size[shortAxis] / scope.size[longAxis]));
        const int left = most / along(longAxis, mostAlong);  // beside as many as a bar needs along it
        const int onShort = along(shortAxis, std::max({evenly, left, fewestLines}));
        const int onLong = along(longAxis, std::min(mostAlong, most / onShort));
        return {uIsLong ? onLong : onShort, uIsLong ? onShort : onLong};
    }
    /// The place of point `i` of `count`, −1 … 1: off the middle, so that no point lies in a plane of symmetry.
    double place(int i, int count) const {
        if (nearBorders && (i == 0 || i == count - 1)) return (i == 0 ? -1 : 1) * (1 - 2 * borderShare);
        return 2 * (i + 0.535) / count - 1;
    }
};

}  // namespace sgm::lower
