// Triangles for a planar region with holes.
// Enters: the edges around it. Leaves: triangles over their vertices alone. Assumes that the region is close to a
// plane.
#pragma once

#include <array>
#include <span>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// An edge from one vertex to another.
using DirectedEdge = std::array<uint32_t, 2>;

/// Appends the triangles of the region to the left of `boundary`, seen against `normal`, to `triangles`; no vertex is
/// added, and triangles run as the boundary does. A short boundary of one loop is cut ear by ear, best shape first; any
/// other becomes a constrained Delaunay triangulation. False, with nothing appended, when the boundary crosses or
/// touches itself, runs the wrong way or doesn't close, seen along the coordinate axis closest to `normal`; judged
/// exactly on the coordinates given. O(n²) for a short boundary, else O(n log n).
bool triangulatePlanar(std::span<const DirectedEdge> boundary, std::span<const Vec3f> positions, Vec3d normal,
                       std::vector<Triangle>& triangles);

}  // namespace sgm::mesh
