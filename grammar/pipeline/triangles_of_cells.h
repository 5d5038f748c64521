// How many triangles a mesh comes to have where its cells are halved.
// Enters: a mesh and cells of its grid, or a thin part. Leaves: a guess. Assumes that triangles lie in their cells.
#pragma once

#include <cstdint>
#include <vector>

#include "grammar/lower/thin_parts.h"
#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::pipeline {

/// About so many triangles a cell with surface has once it is halved so often.
constexpr size_t trianglesOfHalved(int halvings) { return size_t{3} << 2 * halvings; }

/// About so many triangles a thin part has on both of its sides in cells of `cell_m` metres.
double trianglesOfPart(const lower::ThinPart& part, double cell_m);

/// The numbers of triangles in cells, in the cells' order. O(n) in the mesh.
std::vector<uint32_t> countTriangles(const mesh::Mesh& mesh, const mesh::Grid& grid, const mesh::CellSet& cells);

}  // namespace sgm::pipeline
