#include "modeler/mesh/edit.h"

#include <OpenMesh/Tools/Smoother/JacobiLaplaceSmootherT.hh>
#include <algorithm>
#include <cmath>

#include "modeler/mesh/openmesh.h"

namespace sgm::mesh {
Result<Mesh> smooth(const Mesh& mesh, int passes, Progress* progress) {
    if (passes < 0) return Error{Error::Kind::Usage, "the number of smoothing passes can't be negative"};
    if (passes == 0) return mesh;
    if (progress) progress->begin("smooth", static_cast<uint64_t>(passes));
    HalfEdgeMesh half = toOpenMesh(mesh);
    using Smoother = OpenMesh::Smoother::JacobiLaplaceSmootherT<HalfEdgeMesh>;
    Smoother smoother(half);
    smoother.initialize(Smoother::Tangential_and_Normal, Smoother::C1);
    for (int pass = 0; pass < passes; ++pass) {
        if (cancelled(progress)) return cancelledError();
        smoother.smooth(1);
        tick(progress);
    }
    return fromOpenMesh(half, false);
}

void turnInsideOut(Mesh& mesh) {
    for (Chunk& chunk : mesh.chunks) {
        for (Triangle& t : chunk.triangles) std::swap(t.y, t.z);
        for (Vec3f& n : chunk.normals) n = -n;
        for (CornerNormal& own : chunk.cornerNormals) {
            if (const uint32_t k = own.corner % 3; k != 0) own.corner += k == 1 ? 1 : -1;
            own.normal = -own.normal;
        }
        std::sort(chunk.cornerNormals.begin(), chunk.cornerNormals.end(),
                  [](const CornerNormal& a, const CornerNormal& b) { return a.corner < b.corner; });
    }
}

}  // namespace sgm::mesh
