// A mesh with fans of triangles in place of what they replace.
// Enters: a mesh and fans. Leaves: a mesh of one chunk. Assumes fans that have no triangle in common.
#pragma once

#include <span>

#include "modeler/mesh/tip_fan.h"

namespace sgm::mesh {

/// The mesh in one chunk with the fans, whose `removed` count in the whole mesh, and without vertices that have no
/// triangle any more. O(n).
Mesh withFans(const Mesh& mesh, std::span<const TipFan> fans);

}  // namespace sgm::mesh
