// CGAL's word on a mesh.
// Enters: a finished mesh. Leaves: lines on stdout or stderr. Assumes seconds per million triangles are welcome.
#pragma once

#include "cli/requests.h"
#include "modeler/mesh/validate.h"

namespace sgm::cli {

/// Error::Input unless the mesh is closed, oriented and free of self-intersections, by CGAL; where it is, prints so
/// unless `quiet`.
Status validated(const mesh::Mesh& mesh, bool quiet, Context& context);

/// Warns of a mesh that crosses itself or isn't closed, as smoothing may leave one.
void warnOfFaults(const mesh::Mesh& mesh, Context& context);

}  // namespace sgm::cli
