#include "grammar/pipeline/meshing.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/turn.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/refining.h"
#include "modeler/mesh/edit.h"

namespace sgm::pipeline {
namespace {

/// The angle by which the model's walls stand across the grid; 0 where they lie along it or can't be turned.
double turnOf(const Model& model, const mesh::PolygonizeOptions& options) {
    const derive::Derivation& d = model.derivation;
    const bool isFixed = model.keepsAxes || !d.objects.empty() || !d.reliefs.empty();
    return options.surface != mesh::Surface::Crisp || isFixed ? 0 : derive::facingOf(d);
}

Result<MeshedModel> meshAsItStands(const Model& model, const mesh::Grid& grid, const mesh::PolygonizeOptions& options,
                                   Context& context) {
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
        auto missing = holdThinParts(model, made.mesh, made.grid, options, context, made.counts);
        if (!missing.ok()) return missing.error();
        made.missing = std::move(*missing);
    }
    return made;
}

/// The mesh of the model turned by −angle, turned back.
Result<MeshedModel> meshTurned(const Model& model, double angle, const mesh::Grid& grid,
                               const mesh::PolygonizeOptions& options, Context& context) {
    const auto turned = context.timed("turn", [&] {
        Context own{context.progress, context.threads, {}};
        return makeModel(derive::turned(model.derivation, -angle), own, Objects::Apart);
    });
    if (!turned.ok()) return turned.error();
    const mesh::Grid along = gridOver(*turned, {.cell_m = static_cast<double>(grid.cell_m)}, options.surface);
    auto made = meshAsItStands(*turned, along, options, context);
    if (!made.ok()) return made;
    const Mat3 back = Mat3::rotation({0, 1, 0}, angle);
    mesh::rotate(made->mesh, back);
    if (made->missing)
        for (lower::ThinPart& part : *made->missing)
            for (derive::Scope& place : part.places) place.centre = back * place.centre, place.axes = back * place.axes;
    made->grid = grid;
    made->blocks.clear();
    return made;
}

}  // namespace

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::PolygonizeOptions options,
                             Context& context) {
    options.threads = context.threads;
    const double angle = turnOf(model, options);
    return angle == 0 ? meshAsItStands(model, grid, options, context)
                      : meshTurned(model, angle, grid, options, context);
}

Error noSurface(const Model& model, float cell_m) {
    double thickest_m = 0;
    bool isCut = false;
    for (const derive::Shape& shape : model.derivation.tree.shapes) {
        isCut = isCut || shape.op == rules::Operator::Difference || shape.op == rules::Operator::Intersection;
        if (shape.solid != derive::none) thickest_m = std::max(thickest_m, minComponent(shape.scope.size));
    }
    const auto said = [&](std::string why) {
        return syntax::errorAt(model.derivation.tree.shapes[0].span, Error::Kind::Input,
                               fmt::format("there is no surface at cells of {:.3g} m{}", cell_m, why));
    };
    if (isCut || thickest_m > cell_m) return said(": all is cut away, or thinner than a cell");
    return said(
        fmt::format(", for no part is thicker than {:.3g} m: cells of half of that hold such parts", thickest_m));
}

Result<volume::Volume> levelSet(const Model& model, const MeshedModel& meshed, Context& context) {
    return context.timed("level set", [&]() -> Result<volume::Volume> {
        const auto sampled = [&](const std::vector<mesh::Block>& blocks) {
            return volume::sample(blocks, model.tape, meshed.grid, volume::usualHalfWidth, context.threads,
                                  context.progress);
        };
        if (!meshed.blocks.empty()) return sampled(meshed.blocks);
        mesh::Counts counts;
        const auto blocks = mesh::subdivide(model.tape, meshed.grid, context.threads, context.progress, counts);
        return blocks.ok() ? sampled(*blocks) : blocks.error();
    });
}

}  // namespace sgm::pipeline
