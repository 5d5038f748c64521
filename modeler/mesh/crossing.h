// Whether triangles of one small mesh cross. Enters: corners and their positions. Leaves: a verdict. Assumes a few
// triangles, so that every pair is looked at.
#pragma once

#include <array>
#include <span>

#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Whether two of the triangles touch elsewhere than at corners and edges that they share. Corners are
/// told apart by number; `places` are the positions of each triangle's, metres. Quadratic.
bool anyCross(std::span<const std::array<Vec3f, 3>> places, std::span<const Triangle> triangles);

}  // namespace sgm::mesh
