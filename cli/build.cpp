// sgm build: a grammar to meshes and volumes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <tuple>

#include "cli/animation.h"
#include "cli/cave.h"
#include "cli/commands.h"
#include "cli/delivery.h"
#include "cli/frames.h"
#include "cli/renamed.h"
#include "cli/watch.h"
#include "modeler/core/packages.h"
#include "modeler/export/exporter.h"
#include "modeler/volume/volume.h"

namespace sgm::cli {
namespace {

/// A streamed build never has the whole mesh; Error::Usage names what would need it.
Status checkStream(const BuildRequest& request) {
    const std::pair<bool, const char*> whole[] = {
        {request.edits.smooth > 0, "--smooth"},
        {request.edits.simplify < 1 || request.edits.tolerance_m, "--simplify and --tolerance"},
        {request.edits.keep != mesh::Keep::All, "--keep"},
        {request.validate, "--validate"},
        {surveys(request), "--cave and --floor"},
        {request.out.lod > 1, "--lod"},
        {request.flipNormals, "--flip-normals"},
        {!request.report.empty(), "--report"},
        {!request.animations.empty(), "--animate"}};
    for (const auto& [asked, option] : whole)
        if (asked)
            return Error{Error::Kind::Usage, fmt::format("--stream never holds the whole mesh: leave out {}", option)};
    return checkStreamed(request.out);
}

/// What isn't made from the field isn't cut open with it.
Status checkSection(const BuildRequest& request) {
    if (request.model.section.empty()) return Done{};
    const auto wrong = [](std::string why) -> Status {
        return Error{Error::Kind::Usage, "--section " + std::move(why)};
    };
    if (!request.animations.empty()) return wrong("cuts one model open: leave out --animate");
    if (request.out.collider == "boxes" || request.out.collider == "convex")
        return wrong("doesn't cut terminals open: take --collider mesh");
    for (const std::string& file : allFiles(request.out))
        if (!exporter::exporterFor(file)->wantsMesh() && !exporter::exporterFor(file)->wantsVolume)
            return wrong(fmt::format("cuts meshes and volumes open, and '{}' holds neither", file));
    return Done{};
}

/// What changes meshes needs a file that holds one, or a report about one; volumes leave out components as meshes do.
Status checkEdits(const BuildRequest& request) {
    const auto files = allFiles(request.out);
    if (!request.report.empty() || request.validate || surveys(request) || files.empty()) return Done{};
    const auto holds = [&](auto is) {
        return std::any_of(files.begin(), files.end(),
                           [&](const auto& file) { return is(*exporter::exporterFor(file)); });
    };
    const bool meshes = holds([](const exporter::Exporter& row) { return row.wantsMesh(); });
    const bool volumes = holds([](const exporter::Exporter& row) { return row.wantsVolume; });
    const std::pair<bool, const char*> edits[] = {
        {request.edits.smooth > 0 && !meshes, "--smooth"},
        {request.edits.simplify < 1 && !meshes, "--simplify"},
        {request.edits.tolerance_m.has_value() && !meshes, "--tolerance"},
        {request.edits.keep != mesh::Keep::All && !meshes && !volumes, "--keep"},
        {request.flipNormals && !meshes, "--flip-normals"}};
    for (const auto& [vain, option] : edits)
        if (vain)
            return Error{Error::Kind::Usage,
                         fmt::format("{} changes meshes, and '{}' holds none: leave it out, or add -o model.glb",
                                     option, files.front())};
    return Done{};
}

/// A number in the name of a file is that of a frame.
Status checkNames(const BuildRequest& request) {
    if (!request.animations.empty()) return Done{};
    for (const Target& target : targetsOf(request, 0))
        if (frameName(target.file.string(), 0).ok())
            return Error{Error::Kind::Usage,
                         fmt::format("{} {}: the name numbers frames: add --animate NAME=FROM..TO:FRAMES, or write a "
                                     "name without '%'",
                                     target.option, target.file.string())};
    return Done{};
}

/// What this build of the program can't do: Error::Input names the package.
Status checkPackages(const BuildRequest& request) {
    const std::tuple<bool, Package, const char*> all[] = {
        {surveys(request), Package::OpenVdb, "--cave"},
        {request.validate, Package::Cgal, "--validate"},
        {request.edits.simplify < 1 || request.edits.tolerance_m.value_or(0) > 0, Package::Cgal, "--simplify"},
        {request.out.lod > 1, Package::Cgal, "--lod"},
        {request.out.collider == "mesh", Package::Cgal, "--collider mesh"}};
    for (const auto& [asked, package, option] : all)
        if (asked && !isBuiltWith(package)) return missingPackage(package, option);
    return Done{};
}

/// The agent walks through a cave.
Status checkAgent(const BuildRequest& request) {
    if (request.agent.empty()) return Done{};
    if (!surveys(request)) return Error{Error::Kind::Usage, "--agent walks through a cave: add --cave or --floor FILE"};
    const auto agent = parseAgent(request.agent);
    return agent.ok() ? Status(Done{}) : agent.error();
}

/// What can be refused before the work.
Status checkRequest(const BuildRequest& request) {
    if (const Status s = checkOutputs(request.out); !s.ok()) return s;
    if (const Status s = checkPackages(request); !s.ok()) return s;
    if (const Status s = request.floor.empty() ? Done{} : checkMeshFile("--floor", request.floor); !s.ok()) return s;
    if (request.stream)
        if (const Status s = checkStream(request); !s.ok()) return s;
    if (request.flipNormals && (request.out.collider == "boxes" || request.out.collider == "convex"))
        return Error{
            Error::Kind::Usage,
            fmt::format("--collider {} fills the terminals, and --flip-normals is for hollows: take --collider mesh",
                        request.out.collider)};
    if (request.grid.objectCell_m > 0 && !keepsObjectsApart(request))
        return Error{Error::Kind::Usage,
                     "--object-cell: what is asked for is made of one field, with one cell for all; leave it out"};
    if (const Status s = checkSection(request); !s.ok()) return s;
    if (const Status s = checkEdits(request); !s.ok()) return s;
    if (const Status s = checkNames(request); !s.ok()) return s;
    if (const Status s = checkAgent(request); !s.ok()) return s;
    return wantsLevelSet(request) ? volume::load() : Status(Done{});
}

Status buildOne(const BuildRequest& request) {
    Watch watch(displayOf(request));
    Context context{watch.progress(), request.grid.threads};
    const bool apart = keepsObjectsApart(request);
    const auto model = makeModel(request.model, context, apart ? pipeline::Objects::Apart : pipeline::Objects::Grafted);
    if (!model.ok()) return model.error();
    if (!request.quiet) printWarnings(*model);
    if (request.stream) return stream(request, *model, context);
    if (const Status s = writeMeshless(request, *model, context); !s.ok()) return s;
    if (needsNoMesh(request)) return printFiles(request), Done{};
    auto division = pipeline::divide(*model, request.out.objects);
    if (!division.ok()) return division.error();
    const auto scene = makeScene(*model, request.model, request.grid, request.edits, request.quiet, context);
    if (!scene.ok()) return scene.error();
    auto meshed = makeMesh(*model, request.grid, context, needsPositionsOnly(request) && scene->scene.empty());
    if (!meshed.ok()) return meshed.error();
    return deliver(request, *model, std::move(*division), std::move(*meshed), *scene, context);
}

int build(BuildRequest request) {
    request.model.quiet = request.quiet;
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
    addSectionOption(*command, request->model);
    addGridOptions(*command, request->grid);
    addObjectOptions(*command, request->grid);
    addOutputOptions(*command, request->out);
    command
        ->add_option("--animate", request->animations,
                     "Run a parameter through frames, NAME=FROM..TO:FRAMES; -o needs a number: roof_%04d.glb")
        ->allow_extra_args(false);
    command->add_option("--report", request->report,
                        "Write the figures of this build as JSON; - prints them instead of the summary");
    command->add_flag("--cave", request->cave,
                      "Report on the empty space in the rock: spaces, rooms, passages, entrances, floors, ways");
    command
        ->add_option("--agent", request->agent,
                     "Agent size for walkability: RADIUS,HEIGHT[,SLOPE] in metres and degrees")
        ->default_str(".3,1.8,45");
    command->add_option("--floor", request->floor, "Write the floor on which the agent can stand, as a mesh");
    command->add_flag("--flip-normals", request->flipNormals,
                      "Write the surface facing inward: the model is a hollow, seen from inside");
    addRenamedFlag(*command, "--inward", "--flip-normals", request->flipNormals);
    addEditOptions(*command, request->edits);
    command->add_flag("--validate", request->validate, "Validate with CGAL: closed, oriented, no self-intersections");
    addRenamedFlag(*command, "--judge", "--validate", request->validate);
    command->add_flag("--stream", request->stream,
                      "Mesh and write layer by layer, for a mesh larger than memory: one " +
                          exporter::streamedExtensions() + " file, and nothing that needs the whole mesh");
    command->add_flag("-q,--quiet", request->quiet, "Say nothing but errors");
    command->add_flag("--progress", request->progress,
                      "Print lines `progress: STAGE PERCENT` on the standard error, for other programs");
    command->footer(
        "Examples:\n  sgm build examples/grotto.sgm -o grotto.glb -o grotto.vdb --resolution 256\n"
        "  sgm build examples/cumulus.sgm -o cumulus.vdb --format-option grids=fog --format-option wisps=.6\n"
        "  sgm build examples/tower.sgm --set floors=12 --seed 7 -o tower.obj --report tower.json\n"
        "  sgm build examples/tower.sgm --objects Storey,Roof -o tower.glb -o tower.usda\n"
        "  sgm build examples/tower.sgm --animate peak=0..1:48 -o roof_%04d.glb\n"
        "  sgm build examples/grotto.sgm --start Void --flip-normals --cave -o grotto.glb --floor floor.glb");
    command->callback([request, &exitCode] { exitCode = build(*request); });
}

}  // namespace sgm::cli
