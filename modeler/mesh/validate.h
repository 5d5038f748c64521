// Judgements on a mesh. Enters: a Mesh. Leaves: figures. Bad meshes get bad figures; `measure` assumes that triangles
// name vertices that are there, `validate` looks.
#pragma once

#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Counted over the vertices that triangles use; `volume_m3` by the divergence theorem (positive = outward).
struct MeshFigures {
    uint64_t vertices = 0, triangles = 0, components = 0;
    uint64_t cavities = 0;          ///< of the components: surfaces around air, whose volume is negative
    uint64_t boundaryEdges = 0;     ///< edges of one triangle
    uint64_t nonmanifoldEdges = 0;  ///< edges of three or more, or of two that run the same way
    int64_t euler = 0;              ///< V − E + F
    double volume_m3 = 0, area_m2 = 0;
    Box3f bounds;
};
MeshFigures measure(const Mesh& mesh);
/// The same, after welding vertices of exactly equal position.
MeshFigures measureWelded(const Mesh& mesh);

/// CGAL's word on the mesh. Slow (seconds per million triangles); for tests and `--report` on request.
struct MeshValidation {
    bool closed = false;
    bool selfIntersects = false;
    bool outward = false;
    double volume_m3 = 0;
};
Result<MeshValidation> validate(const Mesh& mesh);

}  // namespace sgm::mesh
