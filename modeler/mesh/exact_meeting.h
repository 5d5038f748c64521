// Whether two triangles of a mesh meet where they shouldn't, without rounding.
// Enters: positions and two triangles. Leaves: a verdict. The implementation is CGAL's.
#pragma once

#include <span>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Whether two triangles have points in common besides common vertices and a common edge. Triangles without area never
/// do.
bool meetWrongly(std::span<const Vec3f> positions, const Triangle& s, const Triangle& t);

}  // namespace sgm::mesh
