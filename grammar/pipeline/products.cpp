#include "grammar/pipeline/products.h"

#include <fmt/format.h>

#include "grammar/lower/objects.h"
#include "grammar/lower/solid_tree.h"
#include "grammar/pipeline/grids.h"
#include "modeler/mesh/edit.h"
#include "modeler/volume/keep.h"

namespace sgm::pipeline {
namespace {

Result<std::vector<mesh::LevelOfDetail>> makeLevels(const Model& model, const mesh::Mesh& finest, float cell_m,
                                                    const ProductRequest& request, const Context& context) {
    const auto meshAt = [&](float coarse_m) -> Result<mesh::Mesh> {
        Context own{context.progress, context.threads, {}};
        const mesh::Grid grid = gridOver(model, {.cell_m = static_cast<double>(coarse_m)}, request.meshing.surface);
        mesh::PolygonizeOptions meshing = request.meshing;
        meshing.halvings = 0;  // coarse levels do without what is thin
        auto meshed = makeMesh(model, grid, meshing, own);
        if (!meshed.ok()) return meshed.error();
        mesh::keepOnly(meshed->mesh, request.edits.keep, coarse_m, own.threads);
        if (request.flipNormals) mesh::turnInsideOut(meshed->mesh);
        return std::move(meshed->mesh);
    };
    auto levels = mesh::makeLevels(finest, {request.levels - 1, context.threads, cell_m, meshAt}, context.progress);
    if (levels.ok() && request.meshing.surface == mesh::Surface::Crisp)
        for (mesh::LevelOfDetail& level : *levels) mesh::correctNormals(level.mesh);
    return levels;
}

}  // namespace

Result<Division> divide(const Model& model, const std::string& objects) {
    const auto choice = lower::parseObjects(objects.empty() ? "material" : objects);
    if (!choice.ok()) return choice.error();
    Division division;
    division.byMaterial = choice->by != lower::ObjectChoice::By::None;
    if (!choice->divides()) return division;
    auto tree = lower::objectTree(model.derivation, *model.lowered, *choice);
    if (!tree.ok()) return tree.error();
    division.objects = std::move(*tree);
    return division;
}

exporter::ExportInput exportInput(const Model& model, const std::filesystem::path& grammarFile) {
    exporter::ExportInput input;
    input.provenance = &model.lowered->provenance;
    input.name = grammarFile.stem();
    input.extras["grammar"] = grammarFile.filename();
    input.extras["seed"] = fmt::format("{}", model.derivation.seed);
    const auto& params = model.derivation.grammar->params;
    for (size_t i = 0; i < params.size(); ++i)
        input.extras["param " + params[i].name] = rules::toText(model.derivation.params[i]);
    return input;
}

void Products::applyTo(exporter::ExportInput& input) const {
    input.mesh = &mesh;
    input.objects = division.objects ? &*division.objects : nullptr;
    input.byMaterial = division.byMaterial;
    input.colliders = colliders.all;
    input.levels = levels;
    input.volume = levelSet ? &*levelSet : nullptr;
}

Result<Products> makeProducts(const Model& model, const MeshedModel& meshed, mesh::Mesh mesh, ProductRequest request,
                              Context& context) {
    Products products;
    products.division = std::move(request.division);
    products.mesh = std::move(mesh);
    if (!request.collider.empty()) {
        auto made = context.timed(
            "colliders", [&] { return makeColliders(request.collider, model, products.mesh, context.progress); });
        if (!made.ok()) return made.error();
        products.colliders = std::move(*made);
    }
    if (request.levels > 1) {
        auto levels = context.timed(
            "levels of detail", [&] { return makeLevels(model, products.mesh, meshed.grid.cell_m, request, context); });
        if (!levels.ok()) return levels.error();
        products.levels = std::move(*levels);
    }
    if (request.levelSet) {
        auto sampled = levelSet(model, meshed, context);
        if (!sampled.ok()) return sampled.error();
        const Status kept = volume::keepOnly(*sampled, request.edits.keep, meshed.grid.cell_m, context.progress);
        if (!kept.ok()) return kept.error();
        products.levelSet = std::move(*sampled);
    }
    return products;
}

Status writeMesh(const Model& model, const mesh::Mesh& mesh, const std::filesystem::path& file, Context& context) {
    exporter::ExportInput input = exportInput(model, model.derivation.grammar->sources[0]->name());
    input.mesh = &mesh;
    input.progress = context.progress;
    return context.timed("write", [&] { return exporter::write(input, file); });
}

Result<field::SolidTree> makeSolidTree(const Model& model, Context& context) {
    return context.timed("solids",
                         [&] { return lower::solidTree(model.derivation, *model.lowered, context.progress); });
}

}  // namespace sgm::pipeline
