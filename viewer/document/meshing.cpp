#include "viewer/document/meshing.h"

#include <fmt/format.h>

#include "grammar/lower/objects.h"

namespace sgm::viewer {

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, const mesh::PolygonizeOptions& options,
                             Stages& stages, Progress* progress) {
    MeshedModel made;
    made.grid = grid;
    auto blocks = timed(stages, "subdivide",
                        [&] { return mesh::subdivide(model.tape, made.grid, options.threads, progress, made.counts); });
    if (!blocks.ok()) return blocks.error();
    made.blocks = std::move(*blocks);
    Stages whole;
    auto mesh = timed(whole, "polygonize",
                      [&] { return mesh::polygonize(made.blocks, made.grid, options, progress, made.counts); });
    if (!mesh.ok()) return mesh.error();
    made.mesh = std::move(*mesh);
    // polygonize samples and makes triangles; its wall time is shared out by the time its workers counted for each.
    const double counted = made.counts.sampleSeconds + made.counts.polygonizeSeconds;
    const double share = counted > 0 ? made.counts.sampleSeconds / counted : 0;
    stages.emplace_back("sample", whole[0].second * share);
    stages.emplace_back("polygonize", whole[0].second * (1 - share));
    return made;
}

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::Rebuild& rebuild, Stages& stages,
                             Progress* progress) {
    MeshedModel made;
    made.grid = grid;
    const auto mesh = rebuild.update(model.tape, grid, progress, made.counts);
    if (!mesh.ok()) return mesh.error();
    made.mesh = **mesh;
    stages.emplace_back("subdivide", made.counts.subdivideSeconds);
    stages.emplace_back("sample", made.counts.sampleSeconds);
    stages.emplace_back("polygonize", made.counts.polygonizeSeconds);
    return made;
}

Error noSurface(const Model& model, float cell_m) {
    return {Error::Kind::Input,
            fmt::format("{}there is no surface at cells of {:.3g} m: all is cut away, or thinner than a cell",
                        syntax::placeText(model.derivation.tree.shapes[0].span), cell_m)};
}

Result<volume::Volume> levelSet(const Model& model, const MeshedModel& meshed, int threads, Progress* progress) {
    constexpr int bandVoxels = 3;  // half-width, OpenVDB's usual
    return volume::sample(meshed.blocks, model.tape, meshed.grid, bandVoxels, threads, progress);
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

}  // namespace sgm::viewer
