#include "tests/plan/skeleton.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>

namespace sgm::plan::test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPolygon = CGAL::Polygon_2<Kernel>;

std::vector<SkeletonFace> skeletonOf(const Polygon& polygon) {
    const auto of = [](const Ring& ring) {
        CgalPolygon result;
        for (const Vec2 p : ring.points) result.push_back({p.x, p.z});
        return result;
    };
    CGAL::Polygon_with_holes_2<Kernel> whole(of(polygon.outer));
    for (const Ring& court : polygon.courts) whole.add_hole(of(court));
    const auto skeleton = CGAL::create_interior_straight_skeleton_2(whole);
    std::vector<SkeletonFace> faces;
    if (!skeleton) return faces;
    Footprint footprint;
    footprint.polygons.push_back(polygon);
    const auto edges = edgesOf(footprint);
    for (auto f = skeleton->faces_begin(); f != skeleton->faces_end(); ++f) {
        SkeletonFace face;
        const auto begin = f->halfedge();
        auto h = begin;
        do {
            const auto p = h->vertex()->point();
            face.corners.push_back({p.x(), p.y()});
            face.depths.push_back(h->vertex()->time());
            h = h->next();
        } while (h != begin);
        const auto from = begin->opposite()->vertex()->point();
        for (size_t i = 0; i < edges.size(); ++i)
            if (edges[i].from == Vec2{from.x(), from.y()}) face.edge = static_cast<uint32_t>(i);
        faces.push_back(face);
    }
    return faces;
}

}  // namespace sgm::plan::test
