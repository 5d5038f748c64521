// sgm build: a grammar to meshes and volumes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/animation.h"
#include "cli/cave.h"
#include "cli/colliders.h"
#include "cli/commands.h"
#include "cli/edits.h"
#include "cli/floating.h"
#include "cli/gaps.h"
#include "cli/levels.h"
#include "cli/messages.h"
#include "cli/missing.h"
#include "cli/numbers.h"
#include "cli/outputs.h"
#include "cli/pipeline.h"
#include "cli/renamed.h"
#include "cli/report.h"
#include "cli/validation.h"
#include "cli/watch.h"
#include "grammar/incremental/pipeline.h"
#include "modeler/core/stopwatch.h"
#include "modeler/export/exporter.h"
#include "modeler/mesh/edit.h"
#include "modeler/mesh/simplify.h"
#include "modeler/volume/keep.h"
#include "viewer/document/files.h"

namespace sgm::cli {
namespace fs = std::filesystem;
namespace {

struct BuildRequest {
    ModelRequest model;
    GridRequest grid;
    OutputRequest out;
    std::vector<std::string> animations;  ///< "NAME=FROM..TO:FRAMES"
    std::string report, agent, floor;     ///< agent as `parseAgent` reads it, "" for the usual one
    EditRequest edits;
    bool validate = false, cave = false, inward = false, stream = false, quiet = false;
};

bool surveys(const BuildRequest& request) { return request.cave || !request.floor.empty(); }

/// Whether the blocks are needed, from which a level set is sampled.
bool wantsLevelSet(const BuildRequest& request) { return wantsVolume(request.out) || surveys(request); }

/// Whether nobody asks for the mesh's normals and origins: neither the files nor edits, the floor and the figures.
bool bareWillDo(const BuildRequest& request) {
    return request.quiet && request.report.empty() && request.edits.smooth == 0 && request.edits.simplify == 1 &&
           !request.edits.tolerance_m && !surveys(request) && bareWillDo(request.out);
}

/// A streamed build never has the whole mesh; Error::Usage names what would need it.
Status checkStream(const BuildRequest& request) {
    const std::pair<bool, const char*> whole[] = {
        {request.edits.smooth > 0, "--smooth"},
        {request.edits.simplify < 1 || request.edits.tolerance_m, "--simplify and --tolerance"},
        {request.edits.keep != "all", "--keep"},
        {request.validate, "--validate"},
        {surveys(request), "--cave and --floor"},
        {request.out.lod > 1, "--lod"},
        {request.inward, "--inward"},
        {!request.report.empty(), "--report"},
        {!request.animations.empty(), "--animate"}};
    for (const auto& [asked, option] : whole)
        if (asked)
            return Error{Error::Kind::Usage, fmt::format("--stream never holds the whole mesh: leave out {}", option)};
    return checkStreamed(request.out);
}

/// What can be refused before the work.
Status checkRequest(const BuildRequest& request) {
    if (const Status s = checkOutputs(request.out); !s.ok()) return s;
    if (const Status s = request.floor.empty() ? Done{} : checkMeshFile("--floor", request.floor); !s.ok()) return s;
    if (request.stream)
        if (const Status s = checkStream(request); !s.ok()) return s;
    if (request.inward && (request.out.collider == "boxes" || request.out.collider == "convex"))
        return Error{Error::Kind::Usage,
                     fmt::format("--collider {} fills the terminals, and --inward is for hollows: take --collider mesh",
                                 request.out.collider)};
    if (request.agent.empty()) return Done{};
    if (!surveys(request)) return Error{Error::Kind::Usage, "--agent walks through a cave: add --cave or --floor FILE"};
    if (const auto agent = parseAgent(request.agent); !agent.ok()) return agent.error();
    return Done{};
}

void say(const BuildRequest& request, const Model& model, const mesh::MeshFigures& f, const Support& support,
         float cell_m, const Colliders& colliders, const Stages& stages) {
    double total = 0;
    for (const auto& stage : stages) total += stage.second;
    fmt::print("{} shapes, {} bonds, {} rules; {} triangles in {} component{}, {:.4g} m³; {:.2f} s\n",
               model.derivation.tree.shapes.size(), model.derivation.tree.bonds.size(),
               model.derivation.classic + model.derivation.morphic, f.triangles, f.components,
               f.components == 1 ? "" : "s", f.volume_m3, total);
    for (const std::string& file : allFiles(request.out)) fmt::print("wrote {}\n", file);
    if (!request.floor.empty()) fmt::print("wrote {}\n", request.floor);
    if (!request.out.collider.empty())
        fmt::print("{} collider{} ({})\n", colliders.all.size(), colliders.all.size() == 1 ? "" : "s",
                   request.out.collider);
    for (const std::string& note : colliders.notes) printMessage("note: collider: {}\n", note);
    sayFloating(model, support, cell_m);
}

/// From a mesh to what was asked for: edits, validation, files, figures.
Status deliver(const BuildRequest& request, const Model& model, const viewer::Division& division, MeshedModel meshed,
               Stages& stages, Progress* progress) {
    std::vector<lower::ThinPart> missing;
    if (!request.quiet || !request.report.empty()) {
        auto found = timed(stages, "thin parts",
                           [&] { return findMissingParts(model, meshed, request.grid.threads, progress); });
        if (!found.ok()) return found.error();
        missing = std::move(*found);
    }
    keepOnly(keepOf(request.edits), meshed, request.grid.threads, request.quiet);
    auto mesh = edited(std::move(meshed.mesh), request.edits, request.grid, meshed.grid.cell_m, stages, progress);
    if (!mesh.ok()) return mesh.error();
    if (mesh->triangleCount() == 0 && !allFiles(request.out).empty()) {
        Error error = viewer::noSurface(model, meshed.grid.cell_m);
        error.message += " (--cell, --resolution)";
        return error;
    }
    if (request.validate)
        if (const Status s = validated(*mesh, stages); !s.ok()) return s;
    if (request.edits.smooth > 0 && !request.validate && !request.quiet) warnOfFaults(*mesh, stages);
    mesh::MeshFigures figures;  // of the solid, before it is turned inside out
    Support support;
    if (!request.quiet || !request.report.empty()) {
        figures = mesh::measure(*mesh);
        support = supportOf(model, *mesh, meshed.grid.cell_m);
        timed(stages, "gaps", [&] { return findCauses(model, *mesh, meshed.grid.cell_m, missing, support), 0; });
    }
    if (request.inward) mesh::turnInsideOut(*mesh);

    exporter::ExportInput input = viewer::exportInput(model, request.model.file);
    input.mesh = &*mesh;
    input.progress = progress;
    division.applyTo(input);
    Colliders colliders;
    if (!request.out.collider.empty()) {
        auto made =
            timed(stages, "colliders", [&] { return makeColliders(request.out.collider, model, *mesh, progress); });
        if (!made.ok()) return made.error();
        colliders = std::move(*made);
        input.colliders = colliders.all;
    }
    const auto levels = timed(stages, "levels of detail", [&] {
        return makeLevels(
            {request.out.lod, meshed.grid.cell_m, meshingOf(request.grid), keepOf(request.edits), request.inward},
            model, *mesh, progress);
    });
    if (!levels.ok()) return levels.error();
    input.levels = *levels;
    std::optional<volume::Volume> level;
    if (wantsLevelSet(request)) {
        auto sampled = timed(stages, "level set", [&] {
            return volume::sample(meshed.blocks, model.tape, meshed.grid, volume::usualHalfWidth, request.grid.threads,
                                  progress);
        });
        if (!sampled.ok()) return sampled.error();
        if (const Status s = volume::keepOnly(*sampled, keepOf(request.edits), meshed.grid.cell_m, progress); !s.ok())
            return s;
        level = std::move(*sampled);
        input.volume = &*level;
    }
    std::optional<volume::Cave> cave;
    mesh::Mesh floor;
    if (surveys(request)) {
        auto surveyed = timed(stages, "cave", [&] {
            return surveyFor({request.agent, request.floor, request.inward}, input);
        });
        if (!surveyed.ok()) return surveyed.error();
        cave = std::move(surveyed->cave);
        floor = std::move(surveyed->floor);
    }
    const Status written = timed(stages, "write", [&] {
        const Status s = writeOutputs(request.out, model, input, request.grid.threads);
        return s.ok() && !request.floor.empty() ? writeFloor(request.floor, input, floor) : s;
    });
    if (!written.ok()) return written;
    if (!request.report.empty())
        if (const Status s = viewer::writeText(request.report, reportJson(model, meshed, figures, support, missing,
                                                                          cave, stages, request.grid.threads));
            !s.ok())
            return s;
    if (request.quiet) return Done{};
    say(request, model, figures, support, meshed.grid.cell_m, colliders, stages);
    fmt::print("{}", levelTable(*levels, mesh->triangleCount()));
    printMissingParts(model, meshed.grid, missing);
    if (cave && request.cave) fmt::print("{}", caveTable(*cave));
    return Done{};
}

/// Meshes and writes layer by layer.
Status stream(const BuildRequest& request, const Model& model, Progress* progress) {
    const Stopwatch watch;
    const mesh::Grid grid = gridOver(model.lowered->field.bounds, request.grid);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(model.tape, grid, request.grid.threads, progress, counts);
    if (!blocks.ok()) return blocks.error();
    size_t triangles = 0;
    exporter::ExportInput input = viewer::exportInput(model, request.model.file);
    input.progress = progress;
    const Status written = streamOutput(request.out, input, [&](const mesh::ChunkVisitor& visit) {
        return mesh::polygonizeInLayers(*blocks, grid, meshingOf(request.grid, bareWillDo(request.out)), progress,
                                        counts, [&](const mesh::Mesh& window, const mesh::Chunk& chunk) {
                                            triangles += chunk.triangles.size();
                                            return visit(window, chunk);
                                        });
    });
    if (!written.ok() || request.quiet) return written;
    fmt::print("{} shapes, {} bonds, {} rules; {} triangles; {:.2f} s\nwrote {}\n", model.derivation.tree.shapes.size(),
               model.derivation.tree.bonds.size(), model.derivation.classic + model.derivation.morphic, triangles,
               watch.seconds(), request.out.files[0]);
    return Done{};
}

/// Whether files of the solid tree are all that is wanted.
bool solidsWillDo(const BuildRequest& request) {
    return solidsWillDo(request.out) && request.report.empty() && !request.validate && !surveys(request);
}

/// Writes the solid tree where that is wanted: before meshing, for a model that isn't exactly one is refused.
Status writeSolids(const BuildRequest& request, const Model& model, Stages& stages, Progress* progress) {
    exporter::ExportInput input = viewer::exportInput(model, request.model.file);
    input.progress = progress;
    return timed(stages, "solids", [&] { return writeSolids(request.out, model, input); });
}

void sayFiles(const BuildRequest& request) {
    if (request.quiet) return;
    for (const std::string& file : allFiles(request.out)) fmt::print("wrote {}\n", file);
}

Status buildOne(const BuildRequest& request) {
    Stages stages;
    Watch watch(request.quiet);
    const auto model = makeModel(request.model, stages, watch.progress());
    if (!model.ok()) return model.error();
    if (!request.quiet) printWarnings(*model);
    if (request.stream) return stream(request, *model, watch.progress());
    if (const Status s = writeSolids(request, *model, stages, watch.progress()); !s.ok()) return s;
    if (solidsWillDo(request)) {
        sayFiles(request);
        return Done{};
    }
    const auto division = viewer::divide(*model, request.out.objects);
    if (!division.ok()) return division.error();
    auto meshed = makeMesh(*model, request.grid, stages, watch.progress(), bareWillDo(request));
    if (!meshed.ok()) return meshed.error();
    return deliver(request, *model, *division, std::move(*meshed), stages, watch.progress());
}

/// The request of one frame: its files by name.
Result<BuildRequest> requestOf(const BuildRequest& request, int frame) {
    BuildRequest one = request;
    std::vector<std::string*> names{&one.out.proxy, &one.report, &one.floor};
    for (std::string& file : one.out.files) names.push_back(&file);
    for (std::string* name : names) {
        if (name->empty()) continue;
        const auto framed = frameName(*name, frame);
        if (!framed.ok()) return framed.error();
        *name = *framed;
    }
    return one;
}

/// Everything that the request writes, in all of so many frames; 0 where it isn't animated.
std::vector<Target> targetsOf(const BuildRequest& request, int frames) {
    std::vector<Target> targets;
    for (int frame = 0; frame < std::max(frames, 1); ++frame) {
        const BuildRequest one = frames == 0 ? request : *requestOf(request, frame);
        for (const std::string& file : one.out.files) targets.push_back({"-o", file});
        for (const auto& [option, file] :
             {std::pair("--proxy", one.out.proxy), {"--floor", one.floor}, {"--report", one.report}})
            if (!file.empty()) targets.push_back({option, file});
    }
    return targets;
}

/// All frames stand in one grid, so that what doesn't move has the same vertices in each: the box around them all.
Result<Box3f> boundsOfFrames(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options,
                             const Animation& animation, Progress* progress) {
    Box3f bounds;
    incremental::Pipeline pipeline;
    for (int frame = 0; frame < animation.frames; ++frame) {
        derive::Options at = options;
        at.params = animation.values(options.params, frame);
        if (const Status done = pipeline.derive(grammar, at, progress); !done.ok()) return done.error();
        if (const Status done = pipeline.lower(progress); !done.ok()) return done.error();
        bounds = hull(bounds, pipeline.model().field.bounds);
    }
    return bounds;
}

Status buildFrames(const BuildRequest& request) {
    if (allFiles(request.out).empty())
        return Error{Error::Kind::Usage, "--animate needs files to write: -o roof_%04d.glb"};
    for (int frame : {0, 1})
        if (const auto one = requestOf(request, frame); !one.ok()) return one.error();
    Stages loading;
    std::vector<fs::path> inputs;
    Watch watch(request.quiet);
    const auto loaded = loadGrammar(request.model, loading, watch.progress(), &inputs);
    if (!loaded.ok()) return loaded.error();
    const std::shared_ptr<const rules::Grammar>& grammar = *loaded;
    auto options = optionsFor(*grammar, request.model);
    if (!options.ok()) return options.error();
    const auto animation = readAnimation(*grammar, request.animations);
    if (!animation.ok()) return animation.error();
    const std::vector<Target> targets = targetsOf(request, animation->frames);
    if (const Status s = checkTargets(targets); !s.ok()) return s;
    if (const Status s = checkAgainstInputs(targets, inputs); !s.ok()) return s;
    const auto bounds = boundsOfFrames(grammar, *options, *animation, watch.progress());
    if (!bounds.ok()) return bounds.error();
    const mesh::Grid grid = gridOver(*bounds, request.grid);
    const mesh::PolygonizeOptions meshing = meshingOf(request.grid, bareWillDo(request));
    mesh::Rebuild rebuild(meshing);
    const auto still = options->params;
    for (int frame = 0; frame < animation->frames; ++frame) {
        Stages stages;
        options->params = animation->values(still, frame);
        const auto model = makeModel(grammar, *options, stages, watch.progress());
        if (!model.ok()) return model.error();
        if (frame == 0 && !request.quiet) printWarnings(*model);
        const BuildRequest framed = *requestOf(request, frame);
        if (const Status s = writeSolids(framed, *model, stages, watch.progress()); !s.ok()) return s;
        if (!request.quiet)
            fmt::print("frame {} of {}, {}: ", frame + 1, animation->frames, animation->text(*grammar, frame));
        if (solidsWillDo(request)) {
            sayFiles(framed);
            continue;
        }
        const auto division = viewer::divide(*model, request.out.objects);
        if (!division.ok()) return division.error();
        auto meshed = wantsLevelSet(request) ? makeMesh(*model, grid, meshing, stages, watch.progress())
                                             : makeMesh(*model, grid, rebuild, stages, watch.progress());
        if (!meshed.ok()) return meshed.error();
        if (const Status s = deliver(framed, *model, *division, std::move(*meshed), stages, watch.progress()); !s.ok())
            return s;
        std::fflush(stdout);
    }
    return Done{};
}

int build(BuildRequest request) {
    Status done = checkRequest(request);
    if (done.ok() && request.animations.empty()) {
        request.model.targets = targetsOf(request, 0);
        done = checkTargets(request.model.targets);
    }
    if (done.ok()) done = request.animations.empty() ? buildOne(request) : buildFrames(request);
    return done.ok() ? 0 : fail(done.error());
}

}  // namespace

void addBuild(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("build", "Grow a grammar and write meshes and volumes");
    auto request = std::make_shared<BuildRequest>();
    addModelOptions(*command, request->model);
    addGridOptions(*command, request->grid);
    addOutputOptions(*command, request->out);
    command
        ->add_option("--animate", request->animations,
                     "Run a parameter through frames, NAME=FROM..TO:FRAMES; -o needs a number: roof_%04d.glb")
        ->allow_extra_args(false);
    command->add_option("--report", request->report, "Write the figures of this build as JSON");
    command->add_flag("--cave", request->cave,
                      "Report on the air in the rock: spaces, rooms, passages, entrances, floors, ways");
    command
        ->add_option("--agent", request->agent,
                     "Who walks through the cave: RADIUS,HEIGHT[,SLOPE] in metres and degrees")
        ->default_str(".3,1.8,45");
    command->add_option("--floor", request->floor, "Write the floor on which the agent can stand, as a mesh");
    command->add_flag("--inward", request->inward,
                      "Write the surface facing inward: the model is a hollow, seen from inside");
    addEditOptions(*command, request->edits);
    command->add_flag("--validate", request->validate, "Validate with CGAL: closed, oriented, no self-intersections");
    addRenamedFlag(*command, "--judge", "--validate", request->validate);
    command->add_flag("--stream", request->stream,
                      "Mesh and write layer by layer, for a mesh larger than memory: one " +
                          exporter::streamedExtensions() + " file, and nothing that needs the whole mesh");
    command->add_flag("-q,--quiet", request->quiet, "Say nothing but errors");
    command->footer(
        "Examples:\n  sgm build examples/grotto.sgm -o grotto.glb -o grotto.vdb --resolution 256\n"
        "  sgm build examples/cumulus.sgm -o cumulus.vdb --format-option grids=fog --format-option wisps=.6 --proxy "
        "shadow.glb\n"
        "  sgm build examples/tower.sgm --set floors=12 --seed 7 -o tower.obj --report tower.json\n"
        "  sgm build examples/tower.sgm --objects Storey,Roof -o tower.glb -o tower.usda\n"
        "  sgm build examples/tower.sgm --animate peak=0..1:48 -o roof_%04d.glb\n"
        "  sgm build examples/grotto.sgm --start Void --inward --cave -o grotto.glb --floor floor.glb");
    command->callback([request, &exitCode] { exitCode = build(*request); });
}

}  // namespace sgm::cli
