#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "modeler/mesh/validate.h"

namespace sgm::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

}  // namespace

Result<MeshValidation> validate(const Mesh& mesh) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::array<size_t, 3>> polygons;
    points.reserve(mesh.vertexCount());
    polygons.reserve(mesh.triangleCount());
    for (const Chunk& c : mesh.chunks) {
        for (const Vec3f& p : c.positions) {
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return Error{Error::Kind::Input, "a vertex of the mesh is not finite"};
            points.emplace_back(p.x, p.y, p.z);
        }
        for (const Triangle& local : c.triangles) {
            const Triangle t = c.inMesh(local);
            polygons.push_back({t.x, t.y, t.z});
        }
    }
    for (const auto& t : polygons)
        for (const size_t v : t)
            if (v >= points.size())
                return Error{Error::Kind::Input, "a triangle of the mesh names a vertex that isn't there"};

    try {
        MeshValidation judgement;
        // A soup that is no manifold mesh is neither closed nor outward; splitting it where it isn't still lets CGAL
        // see crossings.
        pmp::remove_isolated_points_in_polygon_soup(points, polygons);  // does_bound_a_volume fails on them
        const bool manifold = pmp::is_polygon_soup_a_polygon_mesh(polygons);
        if (!manifold) pmp::orient_polygon_soup(points, polygons);
        SurfaceMesh surface;
        pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
        judgement.selfIntersects = pmp::does_self_intersect(surface);
        if (!manifold) return judgement;
        judgement.closed = CGAL::is_closed(surface);
        if (!judgement.closed) return judgement;
        judgement.volume_m3 = CGAL::to_double(pmp::volume(surface));
        // CGAL's own word on orientation presumes a mesh that doesn't cross itself.
        judgement.outward = !judgement.selfIntersects && surface.number_of_faces() > 0 &&
                            pmp::does_bound_a_volume(surface) && judgement.volume_m3 > 0;
        return judgement;
    } catch (const std::exception& e) {
        return Error{Error::Kind::Internal, std::string("CGAL: ") + e.what()};
    }
}

}  // namespace sgm::mesh
