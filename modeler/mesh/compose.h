// A simplified surface as a mesh again.
// Enters: triangles over vertices of the input. Leaves: a Mesh of one chunk with normals, origins and labels.
#pragma once

#include <span>

#include "modeler/mesh/planes.h"

namespace sgm::mesh {

/// A triangle over vertices of the input, and the input's region that it lies on.
struct SimpleTriangle {
    Triangle corners;
    uint32_t region;
};

/// One chunk, vertices in the order of the input. Corners on planar regions get the plane's normal, others the mean of
/// what `input` has for that vertex and region, where that differs much of what is near the triangle's own normal,
/// and that where all of it is more than 60 degrees off, but in needles; normals and origins only where the input has
/// them, labels likewise. O(n).
Mesh composeMesh(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions, std::span<const Plane> planes,
                 std::span<const SimpleTriangle> triangles);

}  // namespace sgm::mesh
