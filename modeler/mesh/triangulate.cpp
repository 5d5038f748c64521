#include "modeler/mesh/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>

#include "modeler/mesh/plane_points.h"

namespace sgm::mesh {
namespace {

/// Boundaries up to so many edges are cut ear by ear.
constexpr size_t shortBoundary = 24;

using Vertices = CGAL::Triangulation_vertex_base_with_info_2<uint32_t, PlaneKernel>;
using Faces = CGAL::Constrained_triangulation_face_base_2<PlaneKernel,
                                                          CGAL::Triangulation_face_base_with_info_2<bool, PlaneKernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<PlaneKernel, CGAL::Triangulation_data_structure_2<Vertices, Faces>,
                                               CGAL::No_constraint_intersection_tag>;

/// The boundary as one loop of distinct vertices; empty where it is none.
std::vector<uint32_t> oneLoop(std::span<const DirectedEdge> boundary) {
    std::vector<DirectedEdge> edges(boundary.begin(), boundary.end());
    for (size_t i = 1; i < edges.size(); ++i) {
        const auto next = std::find_if(edges.begin() + static_cast<ptrdiff_t>(i), edges.end(),
                                       [&](const DirectedEdge& e) { return e[0] == edges[i - 1][1]; });
        if (next == edges.end()) return {};
        std::swap(*next, edges[i]);
    }
    if (edges.back()[1] != edges.front()[0]) return {};
    std::vector<uint32_t> loop;
    for (const DirectedEdge& e : edges) {
        if (std::find(loop.begin(), loop.end(), e[0]) != loop.end()) return {};
        loop.push_back(e[0]);
    }
    return loop;
}

/// The vertices of a boundary in a triangulation, by number.
class Boundary {
public:
    Boundary(std::span<const DirectedEdge> edges, std::span<const Vec3f> positions, const PlaneProjection& project)
        : edges_(edges) {
        for (const DirectedEdge& e : edges) numbers_.insert(numbers_.end(), e.begin(), e.end());
        std::sort(numbers_.begin(), numbers_.end());
        numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
        handles_.resize(numbers_.size());
        Triangulation::Face_handle near;
        for (const DirectedEdge& e : edges_) {  // neighbours one after the other
            valid_ &= e[0] != e[1];
            for (const uint32_t v : e) {
                Triangulation::Vertex_handle& handle = handleOf(v);
                if (handle != nullptr) continue;
                const size_t before = plane_.number_of_vertices();
                handle = plane_.insert(project(positions[v]), near);
                valid_ &= plane_.number_of_vertices() > before;
                handle->info() = v;
                near = handle->face();
            }
        }
    }

    /// Triangles to the left of the boundary; false where it isn't one.
    bool triangulate(std::vector<Triangle>& triangles) {
        // CGAL takes no constraints between points on one line, nor from a point to itself.
        if (!valid_ || edges_.size() < 3 || plane_.dimension() != 2) return false;
        for (const DirectedEdge& e : edges_) plane_.insert_constraint(handleOf(e[0]), handleOf(e[1]));
        if (!markInside()) return false;
        for (const auto face : plane_.finite_face_handles())
            if (face->info())
                triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        return true;
    }

private:
    using Face = Triangulation::Face_handle;

    Triangulation::Vertex_handle& handleOf(uint32_t v) {
        return handles_[static_cast<size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), v) - numbers_.begin())];
    }

    /// Floods from the faces left of the boundary; false when that comes to its other side.
    bool markInside() {
        for (const auto face : plane_.all_face_handles()) face->info() = false;
        std::vector<Face> right, open;
        for (const DirectedEdge& e : edges_) {
            Face left;
            int opposite = 0;
            // The edge of `left` opposite to that vertex runs from e[0] to e[1], or the other way.
            if (!plane_.is_edge(handleOf(e[0]), handleOf(e[1]), left, opposite)) return false;
            Face other = left->neighbor(opposite);
            if (left->vertex(Triangulation::ccw(opposite))->info() != e[0]) std::swap(left, other);
            right.push_back(other);
            if (!left->info()) left->info() = true, open.push_back(left);
        }
        while (!open.empty()) {
            const Face face = open.back();
            open.pop_back();
            if (plane_.is_infinite(face)) return false;
            for (int i = 0; i < 3; ++i) {
                const Face next = face->neighbor(i);
                if (face->is_constrained(i) || next->info()) continue;
                next->info() = true;
                open.push_back(next);
            }
        }
        return std::none_of(right.begin(), right.end(), [](const Face& f) { return f->info(); });
    }

    std::span<const DirectedEdge> edges_;
    std::vector<uint32_t> numbers_;
    std::vector<Triangulation::Vertex_handle> handles_;
    Triangulation plane_;
    bool valid_ = true;
};

}  // namespace

bool triangulatePlanar(std::span<const DirectedEdge> boundary, std::span<const Vec3f> positions, Vec3d normal,
                       std::vector<Triangle>& triangles) {
    const PlaneProjection project(normal);
    if (boundary.size() < 3) return false;
    if (boundary.size() <= shortBoundary) {
        const std::vector<uint32_t> loop = oneLoop(boundary);
        if (!loop.empty()) return cutEars(loop, positions, project, triangles);
    }
    try {
        return Boundary(boundary, positions, project).triangulate(triangles);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return false;
    }
}

}  // namespace sgm::mesh
