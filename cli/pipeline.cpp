#include "cli/pipeline.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "cli/files.h"
#include "grammar/rules/check.h"
#include "grammar/rules/params.h"
#include "grammar/syntax/parser.h"

namespace sgm::cli {

void addModelOptions(CLI::App& command, ModelRequest& request) {
    command.add_option("FILE", request.file, "Grammar file (.sgm)")->required();
    command.add_option("--start", request.start, "Start symbol (default: the first `start`)");
    command.add_option("--derive", request.derive, "Run this `derive` way instead of the automatic derivation");
    command.add_option("--set", request.settings, "Set a parameter, NAME=VALUE; may be given again")->allow_extra_args(false);
    command.add_option("--style", request.style, "Use a named set of parameter values");
    command.add_option("--seed", request.seed, "Seed of all random choices")->capture_default_str();
    command.add_option("--max-shapes", request.shapeBudget, "Budget of derived shapes")->capture_default_str();
    command.add_option("--max-seconds", request.secondsBudget, "Budget of time for the derivation")->capture_default_str();
}

void addGridOptions(CLI::App& command, GridRequest& request) {
    auto* resolution = command.add_option("--resolution", request.resolution, "Cells along the longest side of the bounds");
    resolution->check(CLI::Range(2, 8192))->capture_default_str();
    command.add_option("--cell", request.cell_m, "Edge of a cell in metres")->check(CLI::PositiveNumber)->excludes(resolution);
    command.add_option("--threads", request.threads, "Threads (0: all)")->check(CLI::Range(0, 1024))->capture_default_str();
}

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::shared_ptr<const rules::Grammar> loadGrammar(const std::string& file, Stages& stages) {
    Result<syntax::SourcePtr> source = readSource(file);
    if (!source.ok()) {
        fail(source.error());
        return nullptr;
    }
    syntax::Diagnostics diagnostics;
    const syntax::Ast ast = timed(stages, "parse", [&] { return syntax::parse(*source, diagnostics); });
    auto grammar = timed(stages, "check", [&] { return rules::check(ast, fileLoader(), diagnostics); });
    for (const syntax::Diagnostic& d : diagnostics.all()) fmt::print(stderr, "{}\n", syntax::render(d));
    return diagnostics.hasErrors() ? nullptr : grammar;
}

namespace {

template <class List, class NameOf>
Result<uint32_t> find(const List& list, const std::string& wanted, const char* what, NameOf nameOf) {
    std::vector<std::string> names;
    for (uint32_t i = 0; i < list.size(); ++i) {
        names.push_back(nameOf(list[i]));
        if (names.back() == wanted) return i;
    }
    const std::string near = syntax::didYouMean(wanted, names);
    return Error{Error::Kind::Usage, fmt::format("no {} is called '{}'{}", what, wanted, near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near))};
}

Status applyStyle(const rules::Grammar& grammar, const std::string& name, derive::Options& options) {
    const rules::Style* style = rules::findStyle(grammar, name, options.start);
    if (!style) {
        const auto other = find(grammar.styles, name, "style", [](const rules::Style& s) { return s.name; });
        if (!other.ok()) return other.error();
        style = &grammar.styles[*other];
    }
    for (const rules::Setting& s : style->settings) options.params[s.param] = s.value;
    return Done{};
}

Status applySetting(const rules::Grammar& grammar, const std::string& text, derive::Options& options) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos) return Error{Error::Kind::Usage, fmt::format("write --set NAME=VALUE instead of '{}'", text)};
    const auto param = find(grammar.params, text.substr(0, equals), "parameter", [](const rules::Param& p) { return p.name; });
    if (!param.ok()) return param.error();
    Result<rules::Value> value = rules::parseValue(grammar.params[*param], text.substr(equals + 1));
    if (!value.ok()) return Error{Error::Kind::Input, fmt::format("--set {}: {}", text, value.error().message)};
    options.params[*param] = *value;
    return Done{};
}

}  // namespace

Result<derive::Options> optionsFor(const rules::Grammar& grammar, const ModelRequest& request) {
    derive::Options options;
    options.seed = request.seed;
    options.derive = request.derive;
    options.budget.shapes = request.shapeBudget;
    options.budget.seconds = request.secondsBudget;
    if (grammar.starts.empty()) return Error{Error::Kind::Input, fmt::format("{}: no `start`, so there is nothing to build", request.file)};
    if (!request.start.empty()) {
        const auto start = find(grammar.starts, request.start, "start", [&](const rules::Start& s) { return grammar.symbols[s.symbol].name; });
        if (!start.ok()) return start.error();
        options.start = *start;
    }
    options.params = rules::valuesOf(grammar, options.start);
    if (!request.derive.empty()) {
        const auto way = find(grammar.derives, request.derive, "derive way", [](const rules::Derive& d) { return d.name; });
        if (!way.ok()) return way.error();
    }
    if (!request.style.empty())
        if (const Status s = applyStyle(grammar, request.style, options); !s.ok()) return s.error();
    for (const std::string& setting : request.settings)
        if (const Status s = applySetting(grammar, setting, options); !s.ok()) return s.error();
    return options;
}

Result<Model> makeModel(const ModelRequest& request, Stages& stages, Progress* progress) {
    const auto grammar = loadGrammar(request.file, stages);
    if (!grammar) return Error{Error::Kind::Input, ""};  // the diagnostics are out already
    const auto options = optionsFor(*grammar, request);
    if (!options.ok()) return options.error();
    return makeModel(grammar, *options, stages, progress);
}

Result<Model> makeModel(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Stages& stages, Progress* progress) {
    auto derivation = timed(stages, "derive", [&] { return derive::derive(grammar, options, progress); });
    if (!derivation.ok()) return derivation.error();
    auto lowered = timed(stages, "lower", [&] { return lower::lower(*derivation, progress); });
    if (!lowered.ok()) return lowered.error();
    const lower::Model& model = **lowered;
    eval::Tape tape = timed(stages, "compile", [&] { return eval::compile(model.graph, model.field, model.graph.constants()); });
    return Model{std::move(*derivation), std::move(*lowered), std::move(tape)};
}

mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request) {
    return mesh::gridFor(bounds, request.cell_m > 0 ? static_cast<float>(request.cell_m) : mesh::cellFor(bounds, request.resolution));
}

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, int threads, Stages& stages, Progress* progress) {
    MeshedModel made;
    made.grid = grid;
    auto blocks = timed(stages, "subdivide", [&] { return mesh::subdivide(model.tape, made.grid, threads, progress, made.counts); });
    if (!blocks.ok()) return blocks.error();
    made.blocks = std::move(*blocks);
    const mesh::PolygonizeOptions options{.threads = threads};
    Stages whole;
    auto mesh = timed(whole, "polygonize", [&] { return mesh::polygonize(made.blocks, made.grid, options, progress, made.counts); });
    if (!mesh.ok()) return mesh.error();
    made.mesh = std::move(*mesh);
    // polygonize samples and makes triangles; its wall time is shared out by the time its workers counted for each.
    const double counted = made.counts.sampleSeconds + made.counts.polygonizeSeconds;
    const double share = counted > 0 ? made.counts.sampleSeconds / counted : 0;
    stages.emplace_back("sample", whole[0].second * share);
    stages.emplace_back("polygonize", whole[0].second * (1 - share));
    return made;
}

Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::Rebuild& rebuild, Stages& stages, Progress* progress) {
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

Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Stages& stages, Progress* progress) {
    return makeMesh(model, gridOver(model.lowered->field.bounds, request), request.threads, stages, progress);
}

int fail(const Error& error) {
    if (!error.message.empty()) fmt::print(stderr, "sgm: {}\n", error.message);
    switch (error.kind) {
        case Error::Kind::Usage: return 2;
        case Error::Kind::Budget: return 3;
        case Error::Kind::Cancelled: return 130;
        case Error::Kind::Input:
        case Error::Kind::Internal: return 1;
    }
    return 1;
}

}  // namespace sgm::cli
