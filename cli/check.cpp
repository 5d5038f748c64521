// sgm check: every problem of every file, those of the models that `sgm build` would make of it among them, then the
// grammar's own `check … expect` tests.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/requests.h"
#include "cli/trials.h"
#include "cli/validators.h"
#include "cli/watch.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/checks.h"
#include "grammar/pipeline/files.h"
#include "grammar/syntax/parser.h"

namespace sgm::cli {
namespace {

struct CheckRequest {
    std::vector<std::string> files;
    /// What `sgm build` would make; its seed and time are those of `check` lines too.
    pipeline::ModelChoice model;
    double otherSeconds = 5;  ///< for the models of other starts, styles and ends of ranges
    GridRequest grid;         ///< of the mesh that is looked at
    bool json = false;
};

/// Failed checks become errors at their `check` line, so that text and JSON show them like any other problem.
int runGrammarChecks(const std::shared_ptr<const rules::Grammar>& grammar, const CheckRequest& request,
                     syntax::Diagnostics& diagnostics) {
    Watch watch(false);
    Context context{watch.progress(), request.grid.threads};
    const auto verdicts = pipeline::runChecks(grammar, request.model.seed, context, request.model.secondsBudget);
    if (!verdicts.ok()) return fail(verdicts.error());
    for (const pipeline::Verdict& v : *verdicts)
        if (!v.passed) diagnostics.error(v.span, v.message);
    return 0;
}

/// One line: nothing is wrong with a grammar whose details need a fine mesh.
void printOfCells(const std::vector<pipeline::MeshWarning>& warnings) {
    printMessage("note: {}{}{}\n", warnings.front().place, warnings.front().text,
                 warnings.size() == 1 ? "" : " (`sgm build` tells more of these cells)");
}

/// What `sgm build` would refuse, and what other settings would; the exit code.
int tryGrammar(const std::string& file, const std::shared_ptr<const rules::Grammar>& grammar,
               const CheckRequest& request, syntax::Diagnostics& diagnostics) {
    Watch watch(false);
    const auto trials =
        tryModels(grammar, {request.model, request.otherSeconds, request.grid}, watch.progress(), diagnostics);
    if (!trials.ok()) return fail(trials.error());
    if (trials->tried < trials->all && !request.json)
        printMessage("note: {}: {} of {} settings were tried in {:g} s (--try-seconds)\n", file, trials->tried,
                     trials->all, request.otherSeconds);
    if (!trials->ofCells.empty() && !request.json) printOfCells(trials->ofCells);
    return trials->budgetSpent ? 3 : 0;
}

/// "fine", or how many warnings there are.
std::string verdictOn(const syntax::Diagnostics& warnings) {
    const size_t count = warnings.all().size();
    return count == 0 ? "fine" : fmt::format("no errors, {} warning{}", count, count == 1 ? "" : "s");
}

int checkOne(const std::string& file, const CheckRequest& request, nlohmann::json& found) {
    const auto source = pipeline::readSource(file);
    if (!source.ok()) return fail(source.error());
    syntax::Diagnostics diagnostics;
    pipeline::FilesRead inputs;
    const auto grammar = rules::load(*source, operations::table(), pipeline::fileLoader(nullptr, &inputs), diagnostics);
    int code = grammar ? tryGrammar(file, grammar, request, diagnostics) : inputs.overBudget ? 3 : 0;
    if (grammar && code != 130) code = std::max(code, runGrammarChecks(grammar, request, diagnostics));
    if (request.json) {
        for (auto& entry : nlohmann::json::parse(syntax::toJson(diagnostics))) found.push_back(std::move(entry));
    } else {
        printDiagnostics(diagnostics);
        if (!diagnostics.hasErrors() && code == 0) fmt::print("{}: {}\n", file, verdictOn(diagnostics));
    }
    return diagnostics.hasErrors() ? std::max(1, code) : code;
}

int check(const CheckRequest& request) {
    int code = 0;
    nlohmann::json found = nlohmann::json::array();
    for (const std::string& file : request.files) code = std::max(code, checkOne(file, request, found));
    if (request.json) fmt::print("{}\n", found.dump(2));
    return code;
}

}  // namespace

void addCheck(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "check", "Show every problem of grammar files, also of what they derive, and run their `check` lines");
    auto request = std::make_shared<CheckRequest>();
    command->add_option("FILE", request->files, "Grammar files (.sgm)")->required();
    request->model.secondsBudget = 60;
    addChoiceOptions(*command, request->model);
    command->get_option("--max-seconds")
        ->description("Budget of time for the model, and for all `check` lines of a file");
    command
        ->add_option("--try-seconds", request->otherSeconds,
                     "Budget of time for the other models: each start, style and `derive` way, and each parameter at "
                     "the ends of its range, with what else is said here")
        ->check(between(0, 1e9))
        ->capture_default_str();
    addGridOptions(*command, request->grid);
    command->add_flag("--json", request->json, "Problems as JSON, for editors");
    command->footer(
        "Examples:\n  sgm check my.sgm\n  sgm check my.sgm --start Tower --style Tall --set floors=12\n"
        "  sgm check examples/*.sgm --json");
    command->callback([request, &exitCode] { exitCode = check(*request); });
}

}  // namespace sgm::cli
