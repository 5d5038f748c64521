// sgm tree: the derivation as an indented tree.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/requests.h"
#include "cli/watch.h"
#include "grammar/derive/print.h"

namespace sgm::cli {
namespace {

struct TreeRequest {
    ModelRequest model;
    bool json = false, steps = false;
};

int tree(const TreeRequest& request) {
    Watch watch(false);
    Context context{watch.progress()};
    const auto grammar = loadGrammar(request.model, context);
    if (!grammar.ok()) return fail(grammar.error());
    const auto options = optionsFor(**grammar, request.model);
    if (!options.ok()) return fail(options.error());
    const auto derivation = derive::derive(*grammar, *options, watch.progress());
    if (!derivation.ok()) return fail(derivation.error());
    printDiagnostics(derive::warnings(*derivation));
    fmt::print("{}", request.json ? derive::toJson(*derivation) : derive::toText(*derivation, request.steps));
    return 0;
}

}  // namespace

void addTree(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("tree", "Show the derived shape tree: rules, joints, bonds");
    auto request = std::make_shared<TreeRequest>();
    addModelOptions(*command, request->model);
    command->add_flag("--json", request->json, "As JSON");
    command->add_flag("--steps", request->steps, "Also the log of rule applications");
    command->footer("Example:\n  sgm tree examples/figure1.sgm --derive left --steps");
    command->callback([request, &exitCode] { exitCode = tree(*request); });
}

}  // namespace sgm::cli
