// Small polygons in space to triangles.
// Enters: a loop of points that is about flat. Leaves: triangles over them that face along one direction. Assumes a
// loop that doesn't cross itself, seen along that direction.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// One worker's triangulator, reused from polygon to polygon.
class SmallPolygon {
public:
    /// Begins a polygon.
    void clear() { points_.clear(), triangles_.clear(); }
    /// The next corner, counter-clockwise seen against the normal.
    void add(Vec3d point) { points_.push_back(point); }
    /// Twice the polygon's area, along its mean normal.
    Vec3d doubleArea() const;
    /// Triangulates the polygon over its `normal`, unit, by ears, the best shaped first. Where a triangle of a `curved`
    /// polygon of up to eight corners turns more than 37 degrees from the normal, as beside a corner far off the plane
    /// of the others, so that the worst triangle is shaped as well as may be. `mayJoin(i, k)`: whether corners i and
    /// k may have a diagonal. False where there are no ears that face along the normal. O(n³).
    template <class MayJoin>
    bool triangulate(Vec3d normal, bool curved, MayJoin&& mayJoin) {
        normal_ = normal;
        beginRing();
        while (ring_.size() > 3) {
            const size_t count = ring_.size(), best = bestEar(mayJoin);
            if (best == count) return false;
            triangles_.push_back({ring_[(best + count - 1) % count], ring_[best], ring_[(best + 1) % count]});
            ring_.erase(ring_.begin() + static_cast<ptrdiff_t>(best));
        }
        if (!(shapeOf(ring_[0], ring_[1], ring_[2]) > 0)) return false;
        triangles_.push_back({ring_[0], ring_[1], ring_[2]});
        if (!curved || points_.size() == 3 || points_.size() > mostCompared || !turnsMuch()) return true;
        beginRing();
        for (size_t width = 1; width < ring_.size(); ++width)
            for (size_t i = 0; i + width < ring_.size(); ++i)
                findApex(i, i + width, width == 1 || width + 1 == ring_.size() || mayJoin(i, i + width));
        takeBest();
        return true;
    }
    /// The corners of the triangles, as numbers of the polygon's.
    std::span<const std::array<size_t, 3>> triangles() const { return triangles_; }

private:
    static constexpr size_t mostCompared = 8;  ///< corners of a polygon of which all triangulations may be compared

    double shapeOf(size_t a, size_t b, size_t c) const;
    bool isEar(size_t before, size_t at, size_t after) const;
    void findApex(size_t i, size_t j, bool isAllowed);
    void takeBest();
    bool turnsMuch() const;
    void beginRing();

    /// The place in the ring of the best shaped ear, its size for none.
    template <class MayJoin>
    size_t bestEar(MayJoin&& mayJoin) const {
        const size_t count = ring_.size();
        size_t best = count;
        double most = 0;
        for (size_t i = 0; i < count; ++i) {
            const size_t before = ring_[(i + count - 1) % count], after = ring_[(i + 1) % count];
            const double shape = shapeOf(before, ring_[i], after);
            if (shape > most && mayJoin(before, after) && isEar(before, ring_[i], after)) best = i, most = shape;
        }
        return best;
    }

    Vec3d normal_;
    std::vector<Vec3d> points_;
    std::vector<size_t> ring_;  ///< what is left of the polygon; all of it once triangulations are compared
    /// By first and last corner of a part of the polygon: the shape of its worst triangle, and the third corner of the
    /// triangle at the diagonal between both.
    std::array<std::array<double, mostCompared>, mostCompared> worst_;
    std::array<std::array<size_t, mostCompared>, mostCompared> apex_;
    std::vector<std::array<size_t, 2>> parts_;  ///< that are still to be cut
    std::vector<std::array<size_t, 3>> triangles_;
};

}  // namespace sgm::mesh
