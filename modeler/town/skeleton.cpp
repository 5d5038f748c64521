#include "modeler/town/skeleton.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>

#include <exception>
#include <map>

namespace sgm::town {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPolygon = CGAL::Polygon_2<Kernel>;

std::vector<std::vector<plan::Vec2>> skeletonFaces(const plan::Polygon& polygon) {
    const auto ringOf = [](const plan::Ring& ring) {
        CgalPolygon result;
        for (const plan::Vec2 p : ring.points) result.push_back({p.x, p.z});
        return result;
    };
    CGAL::Polygon_with_holes_2<Kernel> whole(ringOf(polygon.outer));
    for (const plan::Ring& court : polygon.courts) whole.add_hole(ringOf(court));
    const auto edges = plan::edgesOf(plan::footprintOf(polygon));
    std::map<std::pair<double, double>, size_t> edgeAt;
    for (size_t i = 0; i < edges.size(); ++i) edgeAt[{edges[i].from.x, edges[i].from.z}] = i;
    std::vector<std::vector<plan::Vec2>> faces(edges.size());
    try {
        const auto skeleton = CGAL::create_interior_straight_skeleton_2(whole);
        if (!skeleton) return {};
        for (auto f = skeleton->faces_begin(); f != skeleton->faces_end(); ++f) {
            const auto begin = f->halfedge();
            const auto from = begin->opposite()->vertex()->point();
            const auto edge = edgeAt.find({from.x(), from.y()});
            if (edge == edgeAt.end()) return {};
            std::vector<plan::Vec2>& face = faces[edge->second];
            face.push_back({from.x(), from.y()});
            for (auto h = begin; h->next() != begin; h = h->next()) {
                const auto p = h->vertex()->point();
                face.push_back({p.x(), p.y()});
            }
        }
    } catch (const std::exception&) {
        return {};  // its preconditions judge what ours let pass
    }
    for (const auto& face : faces)
        if (face.size() < 3) return {};
    return faces;
}

}  // namespace sgm::town
