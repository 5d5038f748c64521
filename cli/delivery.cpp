#include "cli/delivery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cave.h"
#include "cli/levels.h"
#include "cli/messages.h"
#include "cli/report.h"
#include "cli/validation.h"
#include "grammar/lower/objects.h"
#include "grammar/pipeline/buried.h"
#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/gaps.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/missing.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/packages.h"
#include "modeler/mesh/edit.h"

namespace sgm::cli {
namespace {

/// What is known of a build when it is done.
struct Figures {
    std::vector<lower::ThinPart> missing;
    std::vector<pipeline::MeshWarning> buried;
    mesh::MeshFigures mesh;  ///< of the solid, before it is turned inside out
    Support support;
    std::optional<volume::Cave> cave;
};

bool wantsFigures(const BuildRequest& request) { return !request.quiet || !request.report.empty(); }

/// Warns where the mesh is much shorter than the field's bounds, along which cells are counted: blends, noise and cuts
/// may leave much of these empty.
void warnOfWideBounds(const BuildRequest& request, const Model& model, const MeshedModel& meshed) {
    constexpr double usualShare = .6;
    const Box3f bounds = meshed.mesh.bounds();
    const double wide_m = static_cast<double>(maxComponent(model.lowered->field.bounds.size()));
    const double long_m = bounds.empty() ? 0 : static_cast<double>(maxComponent(bounds.size()));
    if (request.quiet || request.grid.cell_m > 0 || !(long_m > 0 && long_m < usualShare * wide_m)) return;
    printMessage(
        "warning: the mesh is {:.3g} m long, {:.0f} of the {} cells, which are counted along the {:.3g} m that its "
        "shapes may reach; --cell {:g} gives it as many\n",
        long_m, std::ceil(long_m / static_cast<double>(meshed.grid.cell_m)), request.grid.resolution, wide_m,
        pipeline::withTwoDigits(long_m / request.grid.resolution));
}

/// The mesh as it is written, but for its sense.
Result<mesh::Mesh> editMesh(const BuildRequest& request, const Model& model, MeshedModel& meshed,
                            const mesh::Scene& scene, Context& context) {
    warnOfWideBounds(request, model, meshed);
    const bool quiet = request.quiet || reportsToStdout(request);  // of what goes to stdout
    keepOnly(request.edits.keep, meshed, request.grid.threads, quiet);
    const float cell_m = meshed.grid.cell_m;
    size_t otherwise = 0;
    pipeline::MeshEdits edits = request.edits;
    edits.otherwise = &otherwise;
    auto mesh = pipeline::edited(std::move(meshed.mesh), edits, {model.tape, request.grid.surface, cell_m}, context);
    if (!mesh.ok()) return mesh;
    if (mesh->triangleCount() == 0 && scene.empty()) return withOptions(pipeline::noSurface(model, cell_m));
    const double left = otherwise > 0 ? static_cast<double>(mesh->triangleCount()) / static_cast<double>(otherwise) : 0;
    if (request.edits.simplify < 1 && left > request.edits.simplify && !request.quiet)
        printMessage(
            "warning: --simplify {:g}: {:.2g} of the triangles are left, for fewer would cross one another or "
            "turn parts inside out; --resolution takes away more\n",
            request.edits.simplify, left);
    const bool usuallySimplified = request.grid.surface == mesh::Surface::Crisp && request.edits.smooth == 0;
    if (usuallySimplified && !request.edits.tolerance_m && !isBuiltWith(Package::Cgal) && !request.quiet)
        printMessage("note: {}: the mesh keeps all its triangles\n",
                     missingPackage(Package::Cgal, "simplification").message);
    if (request.grid.surface == mesh::Surface::Crisp && request.edits.smooth > 0 && request.edits.simplify == 1 &&
        !request.edits.tolerance_m && !request.quiet)
        printMessage(
            "note: --smooth keeps all {} triangles, for what is smooth is no longer flat: --tolerance 5mm or "
            "--simplify .2 leaves fewer\n",
            mesh->triangleCount());
    if (request.validate && mesh->triangleCount() > 0)
        if (const Status s = validated(*mesh, quiet, context); !s.ok()) return s.error();
    if (request.validate)
        for (const mesh::SceneObject& object : scene.objects)
            if (const Status s = validated(object.mesh, quiet, context); !s.ok()) return s.error();
    if (request.edits.smooth > 0 && !request.validate && !request.quiet) warnOfFaults(*mesh, context);
    return mesh;
}

/// The files but for solid trees, the survey with them.
Status writeFiles(const BuildRequest& request, const Model& model, const pipeline::Products& products,
                  const mesh::Scene& scene, Figures& figures, Context& context) {
    exporter::ExportInput input = pipeline::exportInput(model, request.model.file);
    input.progress = context.progress;
    products.applyTo(input);
    if (!scene.empty()) input.scene = &scene, input.provenance = &scene.ground;
    mesh::Mesh floor;
    if (surveys(request)) {
        auto surveyed = context.timed("cave", [&] {
            return surveyFor({request.agent, request.floor, request.flipNormals, floorFilter(model)}, input);
        });
        if (!surveyed.ok()) return surveyed.error();
        figures.cave = std::move(surveyed->cave);
        floor = std::move(surveyed->floor);
    }
    return context.timed("write", [&] {
        const Status s = writeOutputs(request.out, model, input, request.grid.threads);
        return s.ok() && !request.floor.empty() ? writeFloor(request.floor, input, floor) : s;
    });
}

void printSummary(const BuildRequest& request, const Model& model, const pipeline::Products& products,
                  const mesh::Scene& scene, const mesh::Grid& grid, const Figures& figures, const Stages& stages) {
    double total = 0;
    for (const auto& stage : stages) total += stage.second;
    const mesh::MeshFigures& f = figures.mesh;
    const std::string cavities =
        f.cavities == 0 ? "" : fmt::format(", {} of them {}", f.cavities, f.cavities == 1 ? "a cavity" : "cavities");
    fmt::print("{} shapes, {} rules; {} triangles in {} component{}{}, {:.4g} m³; {:.2f} s\n",
               model.derivation.tree.shapes.size(), model.derivation.classic + model.derivation.morphic, f.triangles,
               f.components, f.components == 1 ? "" : "s", cavities, f.volume_m3, total);
    if (!scene.empty()) {
        uint64_t own = 0;
        for (const mesh::SceneObject& object : scene.objects) own += object.mesh.triangleCount();
        fmt::print("{} object{} at {} place{}; {} triangles, {} at all places\n", scene.objects.size(),
                   scene.objects.size() == 1 ? "" : "s", scene.instances.size(), scene.instances.size() == 1 ? "" : "s",
                   own, scene.triangleCount());
    }
    for (const std::string& file : allFiles(request.out)) fmt::print("wrote {}\n", file);
    if (!request.floor.empty()) fmt::print("wrote {}\n", request.floor);
    if (allFiles(request.out).empty() && request.floor.empty() && request.report.empty())
        fmt::print("wrote no file: '-o FILE' names one, as in '-o model.glb'\n");
    const size_t colliders = products.colliders.all.size();
    if (!request.out.collider.empty())
        fmt::print("{} collider{} ({})\n", colliders, colliders == 1 ? "" : "s", request.out.collider);
    for (const std::string& note : products.colliders.notes) printMessage("note: collider: {}\n", note);
    printMeshWarnings(pipeline::floatingWarnings(model, figures.support, grid.cell_m));
    fmt::print("{}", levelTable(products.levels, products.mesh.triangleCount()));
    printMeshWarnings(figures.buried);
    printMeshWarnings(pipeline::missingWarnings(model, grid, figures.missing));
    if (figures.cave && request.cave) fmt::print("{}", caveTable(*figures.cave));
}

}  // namespace

bool needsPositionsOnly(const BuildRequest& request) {
    return request.quiet && request.report.empty() && request.edits.smooth == 0 && request.edits.simplify == 1 &&
           !request.edits.tolerance_m && !surveys(request) && needsPositionsOnly(request.out);
}

bool needsNoMesh(const BuildRequest& request) {
    return needsNoMesh(request.out) && request.report.empty() && !request.validate && !surveys(request);
}

Status writeMeshless(const BuildRequest& request, const Model& model, Context& context) {
    exporter::ExportInput input = pipeline::exportInput(model, request.model.file);
    input.progress = context.progress;
    return context.timed("solids", [&] { return writeMeshless(request.out, model, input); });
}

bool keepsObjectsApart(const BuildRequest& request) {
    const auto choice = lower::parseObjects(request.out.objects.empty() ? "material" : request.out.objects);
    return !request.stream && !surveys(request) && request.animations.empty() && !request.flipNormals &&
           request.out.lod == 1 && request.out.collider.empty() && request.out.proxy.empty() && choice.ok() &&
           !choice->divides() &&
           std::all_of(request.out.files.begin(), request.out.files.end(), [](const std::string& file) {
               const exporter::Exporter& row = *exporter::exporterFor(file);
               return row.wantsMesh() || row.wantsPlan;
           });
}

Status deliver(const BuildRequest& request, const Model& model, pipeline::Division division, MeshedModel meshed,
               const pipeline::MadeScene& made, Context& context) {
    const mesh::Scene& scene = made.scene;
    Figures figures;
    if (wantsFigures(request) && (request.seeksThinParts || !request.report.empty())) {
        if (!meshed.missing) {
            auto found = context.timed("thin parts", [&] {
                return pipeline::findMissingParts(model, meshed, request.grid.threads, context.progress);
            });
            if (!found.ok()) return found.error();
            meshed.missing = std::move(*found);
        }
        figures.missing = *meshed.missing;
        auto buried =
            context.timed("buried parts", [&] { return pipeline::buriedWarnings(model, meshed.mesh, context); });
        if (!buried.ok()) return buried.error();
        figures.buried = std::move(*buried);
    }
    auto mesh = editMesh(request, model, meshed, scene, context);
    if (!mesh.ok()) return mesh.error();
    if (wantsFigures(request)) {
        figures.mesh = mesh::measure(*mesh);
        figures.support = pipeline::supportOf(model, *mesh, meshed.grid.cell_m);
        const Status caused = context.timed("gaps", [&] {
            return pipeline::findCauses(model, *mesh, meshed.grid.cell_m, figures.missing, figures.support,
                                        context.progress);
        });
        if (!caused.ok()) return caused;
    }
    if (request.flipNormals) mesh::turnInsideOut(*mesh);
    const auto products =
        pipeline::makeProducts(model, meshed, std::move(*mesh),
                               {std::move(division), request.out.collider, request.out.lod, wantsLevelSet(request),
                                request.flipNormals, request.edits, meshingOf(request.grid)},
                               context);
    if (!products.ok()) return products.error();
    if (const Status s = writeFiles(request, model, *products, scene, figures, context); !s.ok()) return s;
    if (!request.report.empty()) {
        const std::string json = reportJson(model, meshed, figures.mesh, made, figures.support, figures.missing,
                                            figures.cave, context.stages, request.grid.threads);
        if (reportsToStdout(request))
            fmt::print("{}\n", json);
        else if (const Status s = writeFile(request.report, json); !s.ok())
            return s;
    }
    if (!request.quiet && !reportsToStdout(request))
        printSummary(request, model, *products, scene, meshed.grid, figures, context.stages);
    return Done{};
}

Status stream(const BuildRequest& request, const Model& model, Context& context) {
    const Stopwatch watch;
    const mesh::Grid grid = gridOver(model, request.grid);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(model.tape, grid, request.grid.threads, context.progress, counts);
    if (!blocks.ok()) return blocks.error();
    size_t triangles = 0;
    exporter::ExportInput input = pipeline::exportInput(model, request.model.file);
    input.progress = context.progress;
    const Status written = streamOutput(request.out, input, [&](const mesh::ChunkVisitor& visit) {
        return mesh::polygonizeInLayers(*blocks, grid, meshingOf(request.grid, needsPositionsOnly(request.out)),
                                        context.progress, counts,
                                        [&](const mesh::Mesh& window, const mesh::Chunk& chunk) {
                                            triangles += chunk.triangles.size();
                                            return visit(window, chunk);
                                        });
    });
    if (!written.ok() || request.quiet) return written;
    fmt::print("{} shapes, {} rules; {} triangles; {:.2f} s\nwrote {}\n", model.derivation.tree.shapes.size(),
               model.derivation.classic + model.derivation.morphic, triangles, watch.seconds(), request.out.files[0]);
    return Done{};
}

void printFiles(const BuildRequest& request) {
    if (request.quiet) return;
    for (const std::string& file : allFiles(request.out)) fmt::print("wrote {}\n", file);
}

}  // namespace sgm::cli
