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

namespace {

/// To the tolerance, and then to a share of what is left.
Status simplify(mesh::Mesh& mesh, double tolerance_m, const MeshEdits& edits, const MeshSource& source,
                Context& context) {
    if (tolerance_m > 0) {
        const bool hasCreases = source.surface == mesh::Surface::Crisp && edits.smooth == 0;
        const mesh::SimplifyOptions options{tolerance_m, context.threads, edits.pieces,
                                            hasCreases ? &source.field : nullptr};
        auto result = mesh::simplify(mesh, options, context.progress);
        if (!result.ok()) return result.error();
        mesh = std::move(*result);
    }
    if (edits.otherwise) *edits.otherwise = mesh.triangleCount();
    if (edits.simplify == 1) return Done{};
    auto result = mesh::simplifyToShare(mesh, edits.simplify, context.threads, context.progress);
    if (!result.ok()) return result.error();
    mesh = std::move(*result);
    return Done{};
}

}  // namespace

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
        const Status done =
            context.timed("simplify", [&] { return simplify(mesh, tolerance_m, edits, source, context); });
        if (!done.ok()) return done.error();
    }
    if (surface == mesh::Surface::Crisp) mesh::correctNormals(mesh);
    return mesh;
}

}  // namespace sgm::pipeline
