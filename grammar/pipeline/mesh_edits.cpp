#include "grammar/pipeline/mesh_edits.h"

#include "modeler/core/packages.h"
#include "modeler/mesh/edit.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/tips.h"

namespace sgm::pipeline {

double toleranceOf(const MeshEdits& edits, mesh::Surface surface, float cell_m) {
    if (edits.tolerance_m) return *edits.tolerance_m;
    const bool simplifies = surface == mesh::Surface::Crisp && edits.smooth == 0 && isBuiltWith(Package::Cgal);
    return simplifies ? mesh::usualTolerance(cell_m) : 0;
}

Result<mesh::Mesh> edited(mesh::Mesh mesh, const MeshEdits& edits, const MeshSource& source, Context& context) {
    const mesh::Surface surface = source.surface;
    if (surface == mesh::Surface::Crisp) {
        const auto completed = context.timed("tips", [&] {
            return mesh::completeTips(mesh, source.field, source.cell_m, context.threads, context.progress);
        });
        if (!completed.ok()) return completed.error();
    }
    if (edits.smooth > 0) {
        auto result = context.timed("smooth", [&] { return mesh::smooth(mesh, edits.smooth, context.progress); });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    const double tolerance_m = toleranceOf(edits, surface, source.cell_m);
    if ((edits.simplify < 1 || tolerance_m > 0) && mesh.triangleCount() > 0) {
        const bool hasCreases = surface == mesh::Surface::Crisp && edits.smooth == 0;
        const mesh::SimplifyOptions options{tolerance_m, context.threads, edits.pieces,
                                            hasCreases ? &source.field : nullptr};
        auto result = context.timed("simplify", [&] {
            return edits.simplify < 1 ? mesh::simplifyToShare(mesh, edits.simplify, context.threads, context.progress)
                                      : mesh::simplify(mesh, options, context.progress);
        });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    if (surface == mesh::Surface::Crisp) mesh::correctNormals(mesh);
    return mesh;
}

}  // namespace sgm::pipeline
