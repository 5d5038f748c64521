// One side of a collapse: the triangles that would take the place of those around a vertex.
// Enters: the polygon around them, the original points and edges over it. Leaves: whether they lie within a tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// Triangles over a polygon that all meet in its first corner.
class Fan {
public:
    /// Corners of polygons are at most so many.
    static constexpr int mostCorners = 32;

    /// Sets the polygon, 3 … mostCorners corners counter-clockwise seen against the unit vector `normal`; false where a
    /// triangle of the fan would face away from `normal` by a cosine below `leastFacing`, or be a needle to a
    /// thousandth.
    bool set(std::span<const Vec3f> corners, Vec3f normal, float leastFacing, float tolerance);

    /// The triangle that a point lies over, 1 … corners − 2; the first or the last one where it is beside the fan.
    int triangleOver(Vec3f p) const {
        const Vec3f from = p - apex_;
        bool left = dot(sides_[1], from) >= 0;
        for (int i = 1; i <= last_; ++i) {
            const bool leftOfNext = dot(sides_[i + 1], from) >= 0;
            if (left && !leftOfNext) return i;
            left = leftOfNext;
        }
        return dot(from, arms_[1]) * dot(arms_[last_ + 1], arms_[last_ + 1]) >=
                       dot(from, arms_[last_ + 1]) * dot(arms_[1], arms_[1])
                   ? 1
                   : last_;
    }
    /// A bound on how far a point is from the triangle that it lies over, in the unit of the corners: along the normal,
    /// and twice what it lies outside of the polygon.
    float distance(Vec3f p, int triangle) const {
        const Vec3f from = p - apex_;
        float outside = std::max(0.0f, dot(outer_[triangle], from) - reach_[triangle]);
        if (triangle == 1) outside = std::max(outside, -dot(sides_[1], from));
        if (triangle == last_) outside = std::max(outside, dot(sides_[last_ + 1], from));
        return std::abs(dot(planes_[triangle], from)) + 2 * outside;
    }

    /// Of the sides between the fan's triangles, those that a point is left of, as a mask.
    uint32_t sidesOf(Vec3f p) const {
        const Vec3f from = p - apex_;
        uint32_t mask = 0;
        for (int i = 2; i <= last_; ++i) mask |= static_cast<uint32_t>(dot(sides_[i], from) > 0) << i;
        return mask;
    }
    /// Whether the box around the corners, with room for what is over the polygon, has a face that both ends of an edge
    /// are beyond.
    bool isBeside(Vec3f a, Vec3f b) const {
        const Vec3f low = min(a, b), high = max(a, b);
        return low.x > box_.hi.x || low.y > box_.hi.y || low.z > box_.hi.z || high.x < box_.lo.x ||
               high.y < box_.lo.y || high.z < box_.lo.z;
    }
    /// Whether a point is farther than `reach` beyond a face of that box.
    bool isFar(Vec3f p, float reach) const {
        const Vec3f low = box_.lo - p, high = p - box_.hi;
        return std::max({low.x, low.y, low.z, high.x, high.y, high.z}) > reach;
    }
    /// Whether an original edge ab passes the sides that `between` names, which its ends are on either side of, within
    /// `tolerance`.
    bool crossesWithin(Vec3f a, Vec3f b, uint32_t between, float tolerance) const;

private:
    Vec3f apex_, normal_;
    Box3f box_;
    int last_ = 0;               ///< number of the last triangle
    Vec3f arms_[mostCorners];    ///< by corner: from the apex
    Vec3f sides_[mostCorners];   ///< by corner: what tells by a dot product how far left of its arm a point is
    Vec3f outer_[mostCorners];   ///< by triangle: unit, in the plane, out of its side that the apex isn't on
    float reach_[mostCorners];   ///< by triangle: how far that side is from the apex
    Vec3f planes_[mostCorners];  ///< by triangle, which begins at that corner: height is a dot product with it
};

}  // namespace sgm::mesh
