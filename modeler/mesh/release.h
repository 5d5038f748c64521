// Vertices that were kept inside their cells go to where their creases and corners are.
// Enters: a mesh whose chunks list such vertices, and its flat form. Leaves: positions in the flat form moved. Assumes
// that the mesh doesn't cross itself; afterwards it still doesn't.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/mesh/flat_mesh.h"

namespace sgm::mesh {

/// Moves the vertices in Chunk::confined to their places, all but those whose triangles would fold over or cross
/// others; their neighbours on creases may move along these. Returns how many confined vertices were moved. `threads`
/// 0: all; the result is the same for any number. O(n) where few vertices are confined.
size_t releaseConfined(const Mesh& mesh, FlatMesh& flat, int threads, const Progress* progress);

}  // namespace sgm::mesh
