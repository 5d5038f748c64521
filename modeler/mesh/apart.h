// Components of a mesh that are far enough from one another, each as a mesh of its own.
// Enters: a mesh. Leaves: meshes of one chunk each. Assumes nothing else.
#pragma once

#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The connected components of a mesh in the order of their first triangles; those whose boxes come within `reach_m`
/// metres of one another stay together, with the places that their confined vertices go to. Vertices and triangles keep
/// their order. Empty where all stay together. O(n log n) in the components, O(n) in the triangles; `threads` 0: all.
std::vector<Mesh> splitApart(const Mesh& mesh, double reach_m, int threads);

/// One mesh of one chunk, of meshes of one chunk each that have the same arrays. Nothing is confined any more. O(n).
Mesh join(const std::vector<const Mesh*>& pieces);

/// Whether two meshes of one chunk each are the same but for their place in a grid.
bool sameSurface(const Mesh& a, const Mesh& b);

/// Equal for the same surface.
uint64_t hashSurface(const Mesh& piece);

}  // namespace sgm::mesh
