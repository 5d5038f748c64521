#include "cli/pipeline.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "cli/messages.h"
#include "cli/numbers.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"
#include "grammar/syntax/parser.h"
#include "modeler/core/printable.h"
#include "viewer/document/files.h"

namespace sgm::cli {
namespace {

/// Shapes are counted in 32 bits.
constexpr uint64_t mostShapes = 4'000'000'000;

}  // namespace

void addModelOptions(CLI::App& command, ModelRequest& request) {
    command.add_option("FILE", request.file, "Grammar file (.sgm)")->required();
    command.add_option("--start", request.start, "Start symbol (default: the first `start`)");
    command.add_option("--derive", request.derive, "Run this `derive` way instead of the automatic derivation");
    command.add_option("--set", request.settings, "Set a parameter, NAME=VALUE; may be given again")
        ->allow_extra_args(false);
    command.add_option("--style", request.style, "Use a named set of parameter values");
    command.add_option("--seed", request.seed, "Seed of all random choices")->capture_default_str();
    command.add_option("--max-shapes", request.shapeBudget, "Budget of derived shapes")
        ->check(CLI::Range(uint64_t{1}, mostShapes))
        ->capture_default_str();
    command.add_option("--max-seconds", request.secondsBudget, "Budget of time for the derivation")
        ->check(between(1e-3, 1e9))
        ->capture_default_str();
}

void addGridOptions(CLI::App& command, GridRequest& request) {
    auto* resolution =
        command.add_option("--resolution", request.resolution, "Cells along the longest side of the bounds");
    resolution->check(CLI::Range(2, 8192))->capture_default_str();
    command.add_option("--cell", request.cell_m, "Edge of a cell in metres")
        ->check(between(1e-6, 1e6))
        ->excludes(resolution);
    const std::map<std::string, mesh::Surface> surfaces{{"crisp", mesh::Surface::Crisp},
                                                        {"cubes", mesh::Surface::Cubes}};
    command
        .add_option("--surface", request.surface,
                    "crisp: creases and borders of materials are exact; cubes: plain marching cubes")
        ->transform(CLI::CheckedTransformer(surfaces, CLI::ignore_case))
        ->option_text("{crisp,cubes} [crisp]");
    command.add_option("--threads", request.threads, "Threads (0: all)")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
}

Result<std::shared_ptr<const rules::Grammar>> loadGrammar(const ModelRequest& request, Stages& stages,
                                                          const Progress* progress,
                                                          std::vector<std::filesystem::path>* read) {
    Result<syntax::SourcePtr> source = viewer::readSource(request.file);
    if (!source.ok()) return source.error();
    std::vector<std::filesystem::path> inputs{request.file};
    syntax::Diagnostics diagnostics;
    const syntax::Ast ast =
        timed(stages, "parse", [&] { return syntax::parse(*source, operations::table(), diagnostics); });
    auto grammar =
        timed(stages, "check", [&] { return rules::check(ast, viewer::fileLoader(progress, &inputs), diagnostics); });
    if (cancelled(progress)) return cancelledError();
    printDiagnostics(diagnostics);
    if (diagnostics.hasErrors()) return Error{Error::Kind::Input, ""};
    if (const Status s = checkAgainstInputs(request.targets, inputs); !s.ok()) return s.error();
    if (read) read->insert(read->end(), inputs.begin(), inputs.end());
    return grammar;
}

Result<Model> makeModel(const ModelRequest& request, Stages& stages, Progress* progress) {
    const auto grammar = loadGrammar(request, stages, progress);
    if (!grammar.ok()) return grammar.error();
    const auto options = optionsFor(**grammar, request);
    if (!options.ok()) return options.error();
    return makeModel(*grammar, *options, stages, progress);
}

void printWarnings(const Model& model) { printDiagnostics(derive::warnings(model.derivation)); }

mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request) {
    return mesh::gridFor(
        bounds, request.cell_m > 0 ? static_cast<float>(request.cell_m) : mesh::cellFor(bounds, request.resolution));
}

mesh::PolygonizeOptions meshingOf(const GridRequest& request, bool bare) {
    mesh::PolygonizeOptions options;
    options.surface = request.surface;
    options.threads = request.threads;
    options.bare = bare;
    return options;
}

Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Stages& stages, Progress* progress,
                             bool bare) {
    return makeMesh(model, gridOver(model.lowered->field.bounds, request), meshingOf(request, bare), stages, progress);
}

int fail(const Error& error) {
    constexpr size_t longest = 4000;
    if (!error.message.empty()) printMessage("sgm: {}\n", shortened(printable(error.message, true), longest));
    switch (error.kind) {
        case Error::Kind::Usage:
            return 2;
        case Error::Kind::Budget:
            return 3;
        case Error::Kind::Cancelled:
            return 130;
        case Error::Kind::Input:
        case Error::Kind::Internal:
            return 1;
    }
    return 1;
}

}  // namespace sgm::cli
