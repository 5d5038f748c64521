// Editing a mesh: smoothing and decimation through OpenMesh, which keep it closed and keep its origins; rotating it,
// and turning it inside out. Enters: a Mesh. Leaves: a Mesh, of one chunk when OpenMesh made it. Assumes a closed
// manifold mesh from polygonize.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// `passes` (≥ 0) of OpenMesh's Jacobi-Laplace smoother (tangential and normal, C1); normals are recomputed from faces.
/// Error::Usage for a negative count, Error::Cancelled when `progress` says so.
Result<Mesh> smooth(const Mesh& mesh, int passes, Progress* progress);
/// Quadric decimation to `ratio` in (0, 1] of the triangles, for proxies: topology is kept and no face may turn by more
/// than 60°, so it may stop earlier, but the result may cross itself; `simplify` (simplify.h) never does. Normals are
/// recomputed from faces. Error::Usage for another ratio, Error::Cancelled.
Result<Mesh> decimate(const Mesh& mesh, double ratio, Progress* progress);

/// Gives corners whose normal is more than 53 degrees off that of their triangle the triangle's own: beside parts
/// thinner than a cell a vertex may have the normal of the face behind, and where faces of two parts meet within the
/// tie margin (Tape::tieMargin) that of the other. Slivers have no direction to go by: there it is 90 degrees.
/// O(triangles).
void correctNormals(Mesh& mesh);

/// Rotates the mesh about the origin. O(vertices).
void rotate(Mesh& mesh, const Mat3& rotation);

/// Turns the surface round: triangles are wound and normals point the other way, as for a room seen from inside.
void turnInsideOut(Mesh& mesh);

}  // namespace sgm::mesh
