// What curved_edges.cpp, refine.cpp, simplify.cpp, tips.cpp, triangulate.cpp and validate_exactly.cpp do in a build
// without CGAL.
#include "modeler/core/packages.h"
#include "modeler/mesh/curved_edges.h"
#include "modeler/mesh/refine.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/tips.h"
#include "modeler/mesh/triangulate.h"
#include "modeler/mesh/validate.h"

namespace sgm::mesh {

Result<MeshValidation> validate(const Mesh&) { return missingPackage(Package::Cgal, "validation"); }

bool triangulatePlanar(std::span<const DirectedEdge>, std::span<const Vec3f>, Vec3d, std::vector<Triangle>&) {
    return false;
}

Result<Mesh> simplify(const Mesh&, const SimplifyOptions&, Progress*) {
    return missingPackage(Package::Cgal, "simplification");
}

Result<size_t> completeTips(Mesh&, const eval::Tape&, float, int, Progress*) { return size_t{0}; }

Result<size_t> splitCurvedEdges(Mesh&, const eval::Tape&, double, int, Progress*) { return size_t{0}; }

Result<Refinement> refineCells(const Mesh&, const eval::Tape&, const Grid&, const CellSet&, const RefineOptions&,
                               Progress*) {
    return Refinement();
}

Result<Mesh> simplifyToShare(const Mesh&, double, int, Progress*) {
    return missingPackage(Package::Cgal, "simplification");
}

}  // namespace sgm::mesh
