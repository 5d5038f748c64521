#include "grammar/pipeline/meshing.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/pipeline/refining.h"

namespace sgm::pipeline {

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::PolygonizeOptions options,
                             Context& context) {
    options.threads = context.threads;
    MeshedModel made;
    made.grid = grid;
    auto blocks = context.timed("subdivide", [&] {
        return mesh::subdivide(model.tape, made.grid, options.threads, context.progress, made.counts);
    });
    if (!blocks.ok()) return blocks.error();
    made.blocks = std::move(*blocks);
    const Stopwatch watch;
    auto mesh = mesh::polygonize(made.blocks, made.grid, options, context.progress, made.counts);
    const double seconds = watch.seconds();
    if (!mesh.ok()) return mesh.error();
    made.mesh = std::move(*mesh);
    // polygonize samples and makes triangles; its wall time is shared out by the time its workers counted for each.
    const double counted = made.counts.sampleSeconds + made.counts.polygonizeSeconds;
    const double share = counted > 0 ? made.counts.sampleSeconds / counted : 0;
    context.stages.emplace_back("sample", seconds * share);
    context.stages.emplace_back("polygonize", seconds * (1 - share));
    if (options.surface == mesh::Surface::Crisp && options.halvings > 0) {
        auto missing = holdThinParts(model, made.mesh, made.grid, options, context);
        if (!missing.ok()) return missing.error();
        made.missing = std::move(*missing);
    }
    return made;
}

Error noSurface(const Model& model, float cell_m) {
    double thickest_m = 0;
    bool isCut = false;
    for (const derive::Shape& shape : model.derivation.tree.shapes) {
        isCut = isCut || shape.op == rules::Operator::Difference || shape.op == rules::Operator::Intersection;
        if (shape.solid != derive::none) thickest_m = std::max(thickest_m, minComponent(shape.scope.size));
    }
    const std::string place = syntax::placeText(model.derivation.tree.shapes[0].span);
    if (isCut || thickest_m > cell_m)
        return {Error::Kind::Input,
                fmt::format("{}there is no surface at cells of {:.3g} m: all is cut away, or thinner than a cell",
                            place, cell_m)};
    return {Error::Kind::Input,
            fmt::format("{}there is no surface at cells of {:.3g} m, for no part is thicker than {:.3g} m: cells of "
                        "half of that hold such parts",
                        place, cell_m, thickest_m)};
}

Result<volume::Volume> levelSet(const Model& model, const MeshedModel& meshed, Context& context) {
    return context.timed("level set", [&] {
        return volume::sample(meshed.blocks, model.tape, meshed.grid, volume::usualHalfWidth, context.threads,
                              context.progress);
    });
}

}  // namespace sgm::pipeline
