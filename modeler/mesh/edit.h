// Editing a mesh: smoothing through OpenMesh, which keeps it closed and keeps its origins, and turning it inside out.
// Enters: a Mesh. Leaves: a Mesh, of one chunk when OpenMesh made it. Assumes a closed manifold mesh from polygonize.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// `passes` (≥ 0) of OpenMesh's Jacobi-Laplace smoother (tangential and normal, C1); normals are recomputed from faces.
/// Error::Usage for a negative count, Error::Cancelled when `progress` says so.
Result<Mesh> smooth(const Mesh& mesh, int passes, Progress* progress);
/// Turns the surface round: triangles are wound and normals point the other way, as for a room seen from inside.
void turnInsideOut(Mesh& mesh);

}  // namespace sgm::mesh
