#include "tests/exact/spatial.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <limits>

namespace sgm::exact {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Segments = std::vector<Kernel::Segment_3>;
using TrianglePrimitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using SegmentPrimitive = CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>;
using SearchTraits = CGAL::Search_traits_3<Kernel>;

constexpr double infinite = std::numeric_limits<double>::infinity();

Point pointOf(Vec3d p) { return {p.x, p.y, p.z}; }
Vec3d vecOf(const Point& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct TriangleTree::Impl {
    Triangles triangles;
    std::vector<uint32_t> given;  ///< their numbers; triangles without area are left out
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, TrianglePrimitive>> tree;
};

TriangleTree::TriangleTree(std::span<const Vec3d> points, std::span<const Corners> triangles)
    : impl_(std::make_unique<Impl>()) {
    impl_->triangles.reserve(triangles.size());
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const Corners& t = triangles[i];
        const Kernel::Triangle_3 made(pointOf(points[t.x]), pointOf(points[t.y]), pointOf(points[t.z]));
        if (made.is_degenerate()) continue;
        impl_->triangles.push_back(made);
        impl_->given.push_back(i);
    }
    impl_->tree.rebuild(impl_->triangles.cbegin(), impl_->triangles.cend());
    impl_->tree.accelerate_distance_queries();
}

TriangleTree::~TriangleTree() = default;

double TriangleTree::distance(Vec3d p) const { return std::sqrt(impl_->tree.squared_distance(pointOf(p))); }

TriangleTree::Nearest TriangleTree::nearest(Vec3d p) const {
    const auto [point, t] = impl_->tree.closest_point_and_primitive(pointOf(p));
    const Vec3d a = vecOf(t->vertex(0)), b = vecOf(t->vertex(1)), c = vecOf(t->vertex(2));
    return {{vecOf(point), normalized(cross(b - a, c - a))},
            impl_->given[static_cast<size_t>(t - impl_->triangles.cbegin())]};
}

double TriangleTree::hit(Vec3d from, Vec3d direction, const std::function<bool(const Plane&)>& skipped) const {
    const Kernel::Ray_3 ray(pointOf(from), Kernel::Vector_3(direction.x, direction.y, direction.z));
    const auto met = impl_->tree.first_intersection(ray, [&](Triangles::const_iterator t) {
        const Vec3d a = vecOf(t->vertex(0)), b = vecOf(t->vertex(1)), c = vecOf(t->vertex(2));
        return skipped({a, normalized(cross(b - a, c - a))});
    });
    if (!met) return infinite;
    if (const Point* p = boost::get<Point>(&met->first)) return length(vecOf(*p) - from);
    const auto* s = boost::get<Kernel::Segment_3>(&met->first);
    return s ? std::min(length(vecOf(s->source()) - from), length(vecOf(s->target()) - from)) : infinite;
}

struct SegmentTree::Impl {
    Segments segments;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, SegmentPrimitive>> tree;
};

SegmentTree::SegmentTree(std::span<const Segment> segments) : impl_(std::make_unique<Impl>()) {
    for (const Segment& s : segments) impl_->segments.emplace_back(pointOf(s.a), pointOf(s.b));
    impl_->tree.rebuild(impl_->segments.cbegin(), impl_->segments.cend());
    impl_->tree.accelerate_distance_queries();
}

SegmentTree::~SegmentTree() = default;

double SegmentTree::distance(Vec3d p) const { return std::sqrt(impl_->tree.squared_distance(pointOf(p))); }

struct PointTree::Impl {
    CGAL::Kd_tree<SearchTraits> tree;
};

PointTree::PointTree(std::span<const Vec3d> points) : impl_(std::make_unique<Impl>()) {
    for (const Vec3d& p : points) impl_->tree.insert(pointOf(p));
    impl_->tree.build();
}

PointTree::~PointTree() = default;

double PointTree::distance(Vec3d p) const {
    return std::sqrt(CGAL::Orthogonal_k_neighbor_search<SearchTraits>(impl_->tree, pointOf(p), 1).begin()->second);
}

}  // namespace sgm::exact
