// Apart from the other queries, because CGAL's polygon mesh processing takes a minute to compile.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "tests/exact/spatial.h"

namespace sgm::exact {

uint64_t crossingPairs(std::span<const Vec3d> points, std::span<const Corners> triangles) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
    namespace pmp = CGAL::Polygon_mesh_processing;
    std::vector<Kernel::Point_3> corners;
    std::vector<std::array<size_t, 3>> polygons;
    for (const Vec3d& p : points) corners.emplace_back(p.x, p.y, p.z);
    for (const Corners& t : triangles) polygons.push_back({t.x, t.y, t.z});
    // Splits the soup where it is no manifold.
    if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) pmp::orient_polygon_soup(corners, polygons);
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(corners, polygons, surface);
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
    pmp::self_intersections(surface, std::back_inserter(pairs));
    return pairs.size();
}

}  // namespace sgm::exact
