// `sgm build --validate`: CGAL's judgement of a mesh.
#pragma once

#include "cli/pipeline.h"
#include "modeler/mesh/mesh.h"

namespace sgm::cli {

/// Prints CGAL's word on the mesh as a line; Error::Input when it finds a fault.
Status validated(const mesh::Mesh& mesh, Stages& stages);

}  // namespace sgm::cli
