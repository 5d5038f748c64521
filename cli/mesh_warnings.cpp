#include "cli/mesh_warnings.h"

#include "grammar/pipeline/missing.h"
#include "grammar/pipeline/scene.h"

namespace sgm::cli {
namespace {

Status warnAtCells(const Model& model, const GridRequest& grid, Context& context) {
    const auto meshed = makeMesh(model, grid, context);
    return meshed.ok() ? warnOfMesh(model, *meshed, context) : Status(meshed.error());
}

}  // namespace

Status warnOfMesh(const Model& model, const MeshedModel& meshed, Context& context) {
    const auto warnings = pipeline::meshWarnings(model, meshed, context);
    if (!warnings.ok()) return warnings.error();
    printMeshWarnings(*warnings);
    return Done{};
}

Status warnAsBuild(const Model& drawn, const ModelRequest& request, const GridRequest& grid, Progress* progress) {
    const derive::Derivation& derivation = drawn.derivation;
    Context context{progress, grid.threads};
    if (derivation.copies + derivation.masses == 0) return warnAtCells(drawn, grid, context);
    if (derivation.masses > 0 || !request.section.empty()) return Done{};
    const auto options = optionsFor(*derivation.grammar, request);
    if (!options.ok()) return options.error();
    const auto model = pipeline::makeModel(derivation.grammar, *options, context, pipeline::Objects::Apart);
    if (!model.ok()) return model.error();
    if (!model->lowered->field.bounds.empty())
        if (const Status told = warnAtCells(*model, grid, context); !told.ok()) return told;
    const auto found = pipeline::objectWarnings(*model, sceneRequestOf(request, grid), context);
    if (!found.ok()) return found.error();
    printMeshWarnings(*found);
    return Done{};
}

}  // namespace sgm::cli
