#include "cli/requests.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "cli/messages.h"
#include "cli/validators.h"
#include "cli/watch.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/section.h"
#include "grammar/rules/check.h"
#include "grammar/syntax/parser.h"
#include "modeler/core/printable.h"

namespace sgm::cli {
namespace {

/// Shapes are counted in 32 bits.
constexpr uint64_t mostShapes = 4'000'000'000;

}  // namespace

void addChoiceOptions(CLI::App& command, pipeline::ModelChoice& choice) {
    command.add_option("--start", choice.start, "Start symbol (default: the first `start`)");
    command.add_option("--derive", choice.derive, "Run this `derive` way instead of the automatic derivation");
    command.add_option("--set", choice.settings, "Set a parameter, NAME=VALUE; may be given again")
        ->allow_extra_args(false);
    command.add_option("--style", choice.style, "Use a named set of parameter values");
    command.add_option("--seed", choice.seed, "Seed of all random choices")->check(anySeed())->capture_default_str();
    command.add_option("--max-shapes", choice.shapeBudget, "Budget of derived shapes")
        ->check(wholeNumber(1, mostShapes))
        ->capture_default_str();
    command.add_option("--max-seconds", choice.secondsBudget, "Budget of time for the derivation")
        ->check(between(1e-3, 1e9))
        ->capture_default_str();
}

void addModelOptions(CLI::App& command, ModelRequest& request) {
    command.add_option("FILE", request.file, "Grammar file (.sgm)")->required();
    addChoiceOptions(command, request);
}

namespace {

/// A number of metres, or of a unit behind it.
CLI::AsNumberWithUnit metres() {
    return CLI::AsNumberWithUnit(std::map<std::string, double>{{"mm", .001}, {"cm", .01}, {"m", 1}});
}

}  // namespace

void addSectionOption(CLI::App& command, ModelRequest& request) {
    command.add_option("--section", request.section,
                       "Cut the model open, as x=1.5, y=20cm or z=50% of it: what lies beyond is left out, and the cut "
                       "shows each part in its own material; --section=-x=1.5 leaves out what lies before");
}

void addGridOptions(CLI::App& command, GridRequest& request) {
    auto* resolution =
        command.add_option("--resolution", request.resolution, "Cells along the longest side of the bounds");
    resolution->check(wholeNumber(2, pipeline::mostResolution))->capture_default_str();
    command.add_option("--cell", request.cell_m, "Edge of a cell: .1, 10cm, 5mm")
        ->transform(metres())
        ->check(between(1e-6, 1e6))
        ->excludes(resolution);
    command
        .add_option("--surface", request.surface,
                    "crisp: creases and borders of materials are exact; cubes: plain marching cubes")
        ->transform(namedValue({{"crisp", int(mesh::Surface::Crisp)}, {"cubes", int(mesh::Surface::Cubes)}}))
        ->option_text("{crisp,cubes} [crisp]");
    command
        .add_option("--halvings", request.halvings,
                    "How often crisp cells are halved around parts that are too thin for them: 0 … 3")
        ->check(wholeNumber(0, 3))
        ->capture_default_str();
    command.add_option("--threads", request.threads, "Threads (0: all)")
        ->check(wholeNumber(0, 1024))
        ->capture_default_str();
}

void addObjectOptions(CLI::App& command, GridRequest& request) {
    command
        .add_option(
            "--object-cell", request.objectCell_m,
            "Edge of a cell of objects that 'place' puts, metres [as --cell says; else --resolution cells along "
            "each object's longest side]")
        ->check(between(1e-6, 1e6));
}

void addEditOptions(CLI::App& command, MeshEdits& edits) {
    command
        .add_option("--keep", edits.keep,
                    "Which separate solids stay: all, those that stand and aren't debris, or the largest one; the "
                    "latter two fill closed cavities")
        ->transform(namedValue({{"all", int(mesh::Keep::All)},
                                {"grounded", int(mesh::Keep::Grounded)},
                                {"largest", int(mesh::Keep::Largest)}}))
        ->option_text("{all,grounded,largest} [all]");
    command.add_option("--smooth", edits.smooth, "Passes of Laplacian smoothing")->check(wholeNumber(0, 1000));
    auto* share = command.add_option("--simplify", edits.simplify,
                                     "Simplify to at most this share of the triangles that the mesh has otherwise");
    share->check(between(0.001, 1));
    command
        .add_option("--tolerance", edits.tolerance_m,
                    "How far simplification may move the surface: 5mm, 2cm, .01m; 0 keeps all [a crisp mesh: .01 cell]")
        ->transform(metres())
        ->check(between(0, 1e6))
        ->excludes(share);
}

Result<std::shared_ptr<const rules::Grammar>> loadGrammar(const ModelRequest& request, Context& context,
                                                          std::vector<std::filesystem::path>* read) {
    const EndsAtOnce nothingIsWritten;
    Result<syntax::SourcePtr> source = pipeline::readSource(request.file);
    if (!source.ok()) return source.error();
    pipeline::FilesRead inputs{{request.file}, false};
    syntax::Diagnostics diagnostics;
    const syntax::Ast ast =
        context.timed("parse", [&] { return syntax::parse(*source, operations::table(), diagnostics); });
    auto grammar = context.timed(
        "check", [&] { return rules::check(ast, pipeline::fileLoader(context.progress, &inputs), diagnostics); });
    if (cancelled(context.progress)) return cancelledError();
    if (!request.quiet || diagnostics.hasErrors()) printDiagnostics(diagnostics);
    if (inputs.overBudget)
        return Error{Error::Kind::Budget, "a file that the grammar reads is too large, or would take too much work"};
    if (diagnostics.hasErrors()) return Error{Error::Kind::Reported, "the grammar has errors"};
    if (const Status s = checkAgainstInputs(request.targets, inputs.paths); !s.ok()) return s.error();
    if (read) read->insert(read->end(), inputs.paths.begin(), inputs.paths.end());
    return grammar;
}

Status checkUnchanged(const std::string& file, const rules::Grammar& grammar) {
    const auto now = pipeline::readSource(file);
    if (!now.ok()) return now.error();
    if ((*now)->text() == grammar.sources[0]->text()) return Done{};
    return Error{Error::Kind::Input, fmt::format("'{}' was changed by another program: nothing was saved", file)};
}

Result<Model> makeModel(const ModelRequest& request, Context& context, pipeline::Objects objects) {
    const auto section = request.section.empty() ? Result<pipeline::Section>(pipeline::Section{})
                                                 : pipeline::parseSection(request.section);
    if (!section.ok()) return section.error();
    const auto grammar = loadGrammar(request, context);
    if (!grammar.ok()) return grammar.error();
    const auto options = optionsFor(**grammar, request);
    if (!options.ok()) return options.error();
    if (request.section.empty()) return makeModel(*grammar, *options, context, objects);
    auto derivation = context.timed("derive", [&] { return derive::derive(*grammar, *options, context.progress); });
    if (!derivation.ok()) return derivation.error();
    auto cut = makeModel(std::move(*derivation), *section, context);
    if (!request.quiet && cut.ok() && section->isBeside(cut->lowered->field.bounds))
        printMessage("warning: --section {} cuts nothing: the model reaches from {:.4g} to {:.4g} m\n", request.section,
                     cut->lowered->field.bounds.lo[section->axis], cut->lowered->field.bounds.hi[section->axis]);
    return cut;
}

pipeline::SceneRequest sceneRequestOf(const ModelRequest& request, const GridRequest& grid) {
    pipeline::SceneRequest wanted;
    wanted.resolution = grid.resolution;
    wanted.cell_m = grid.objectCell_m > 0 ? grid.objectCell_m : grid.cell_m;
    wanted.meshing = meshingOf(grid);
    wanted.budget.shapes = request.shapeBudget;
    wanted.budget.seconds = request.secondsBudget;
    return wanted;
}

Result<pipeline::MadeScene> makeScene(const Model& model, const ModelRequest& request, const GridRequest& grid,
                                      const MeshEdits& edits, bool quiet, Context& context) {
    if (model.derivation.objects.empty() && grid.objectCell_m > 0)
        return Error{Error::Kind::Usage, "--object-cell is of objects that 'place' puts, and this model has none"};
    pipeline::SceneRequest wanted = sceneRequestOf(request, grid);
    wanted.edits = edits;
    wanted.seeksThinParts = !quiet;
    auto made = pipeline::makeScene(model, wanted, context);
    if (made.ok() && !quiet) printDiagnostics(made->warnings), printMeshWarnings(made->meshWarnings);
    return made;
}

void printWarnings(const Model& model) { printDiagnostics(derive::warnings(model.derivation)); }

void printMeshWarnings(const std::vector<pipeline::MeshWarning>& warnings) {
    for (const pipeline::MeshWarning& w : warnings) printMessage("warning: {}{}\n", w.place, w.text);
}

void keepOnly(mesh::Keep keep, MeshedModel& meshed, int threads, bool quiet) {
    const mesh::Dropped dropped = mesh::keepOnly(meshed.mesh, keep, meshed.grid.cell_m, threads);
    if (!quiet && dropped.pieces + dropped.cavities > 0)
        fmt::print("left out {} piece{} of {:.4g} m³, filled {} cavit{} of {:.4g} m³\n", dropped.pieces,
                   dropped.pieces == 1 ? "" : "s", dropped.volume_m3, dropped.cavities,
                   dropped.cavities == 1 ? "y" : "ies", dropped.filled_m3);
}

mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request) {
    return pipeline::gridOver(bounds, {request.resolution, request.cell_m});
}

mesh::Grid gridOver(const Model& model, const GridRequest& request) {
    return pipeline::gridOver(model, {request.resolution, request.cell_m}, request.surface);
}

mesh::PolygonizeOptions meshingOf(const GridRequest& request, bool positionsOnly) {
    mesh::PolygonizeOptions options;
    options.surface = request.surface;
    options.halvings = request.halvings;
    options.threads = request.threads;
    options.positionsOnly = positionsOnly;
    return options;
}

Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Context& context, bool positionsOnly) {
    return makeMesh(model, gridOver(model, request), meshingOf(request, positionsOnly), context);
}

int fail(const Error& error) {
    constexpr size_t longest = 4000;
    if (error.kind != Error::Kind::Reported)
        printMessage("sgm: {}\n", shortened(printable(error.message, true), longest));
    switch (error.kind) {
        case Error::Kind::Usage:
            return 2;
        case Error::Kind::Budget:
            return 3;
        case Error::Kind::Cancelled:
            return 130;
        case Error::Kind::Input:
        case Error::Kind::Reported:
        case Error::Kind::Internal:
            return 1;
    }
    return 1;
}

Error withOptions(Error error) {
    error.message += " (--cell, --resolution)";
    return error;
}

}  // namespace sgm::cli
