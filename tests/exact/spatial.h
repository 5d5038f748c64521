// Nearest distances and rays among triangles, segments and points, by CGAL.
// Enters: points and what they span. Leaves: distances. Assumes finite coordinates and at least one triangle, segment
// or point. Building takes O(n log n), a query O(log n) on usual input.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::exact {

using Corners = Vec3<uint32_t>;  ///< three indices of points

struct Segment {
    Vec3d a, b;
};

/// A plane through `point` with the unit normal.
struct Plane {
    Vec3d point, normal;
    double distance(Vec3d p) const { return std::abs(dot(p - point, normal)); }
};

/// A triangle mesh to be asked for distances.
class TriangleTree {
public:
    TriangleTree(std::span<const Vec3d> points, std::span<const Corners> triangles);
    ~TriangleTree();
    /// Metres from `p` to the nearest point of the mesh.
    double distance(Vec3d p) const;
    /// The nearest point of the mesh, with its triangle and that one's normal.
    struct Nearest {
        Plane plane;
        uint32_t triangle;
    };
    Nearest nearest(Vec3d p) const;
    /// Metres along the unit `direction` to the first triangle whose plane isn't skipped, infinite where there is none.
    double hit(Vec3d from, Vec3d direction, const std::function<bool(const Plane&)>& skipped) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Segments to be asked for the nearest one.
class SegmentTree {
public:
    explicit SegmentTree(std::span<const Segment> segments);
    ~SegmentTree();
    /// Metres from `p` to the nearest segment.
    double distance(Vec3d p) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Points to be asked for the nearest one.
class PointTree {
public:
    explicit PointTree(std::span<const Vec3d> points);
    ~PointTree();
    /// Metres from `p` to the nearest point.
    double distance(Vec3d p) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// How many pairs of triangles cross or overlap beyond a shared corner or edge. Seconds per million triangles.
uint64_t crossingPairs(std::span<const Vec3d> points, std::span<const Corners> triangles);

}  // namespace sgm::exact
