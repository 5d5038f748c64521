// Which regions of a surface are planar.
// Enters: a flat mesh, its regions and their borders. Leaves: a plane for each region that has one.
#pragma once

#include "modeler/mesh/surface_regions.h"

namespace sgm::mesh {

/// The points with dot(normal, p) = offset; the normal is a unit vector that points outward, or 0 for a curved region.
struct Plane {
    Vec3d normal;
    double offset = 0;
    bool planar() const { return normal != Vec3d{}; }
    double distance(Vec3f p) const { return dot(normal, p.as<double>()) - offset; }
};

/// By region: the plane that all its vertices lie within `bound_m` of; O(n), on `threads` threads. The normal is that
/// of the region's border by Stokes' theorem, so no triangle is read.
std::vector<Plane> findPlanes(const FlatMesh& mesh, const SurfaceRegions& regions, double bound_m, int threads);

}  // namespace sgm::mesh
