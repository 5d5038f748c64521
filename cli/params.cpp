// sgm params: a grammar's parameters, for people and for other programs' panels.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/requests.h"
#include "grammar/rules/params.h"

namespace sgm::cli {
namespace {

std::string rangeText(const rules::Param& p) {
    if (!p.choices.empty()) return fmt::format("of {}", fmt::join(p.choices, ", "));
    if (!p.lo || !p.hi) return "";
    const std::string lo = rules::toText(*p.lo), hi = rules::toText(*p.hi);
    const bool isReal = rules::kindName(p.value) == "real" && p.value.units[0] == rules::Unit::None;
    const bool looksWhole = lo.find('.') == std::string::npos && hi.find('.') == std::string::npos;
    return fmt::format("in {}..{}{}", lo, hi, isReal && looksWhole ? ".0" : "");  // 0..1 would be whole numbers
}

int params(const std::string& file, bool json, bool panel) {
    Context context;
    ModelRequest request;
    request.file = file;
    const auto loaded = loadGrammar(request, context);
    if (!loaded.ok()) return fail(loaded.error());
    const rules::Grammar* const grammar = loaded->get();
    if (json || panel) {
        fmt::print("{}\n", panel ? rules::panelJson(*grammar) : rules::paramsJson(*grammar));
        return 0;
    }
    const auto values = rules::valuesOf(*grammar, 0);
    for (size_t i = 0; i < values.size(); ++i) {
        const rules::Param& p = grammar->params[i];
        fmt::print("{:16} {:20} {:28} {}{}\n", p.name, rules::toText(values[i]), rangeText(p), p.label,
                   p.group.empty() ? "" : fmt::format("  [{}]", p.group));
    }
    for (const rules::Style& s : grammar->styles)
        fmt::print("style {}{}\n", s.name,
                   s.start == rules::none ? "" : " for " + grammar->symbols[grammar->starts[s.start].symbol].name);
    return 0;
}

}  // namespace

void addParams(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("params", "List a grammar's parameters and styles");
    auto file = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false), panel = std::make_shared<bool>(false);
    command->add_option("FILE", *file, "Grammar file (.sgm)")->required();
    command->add_flag("--json", *json, "As JSON: name, kind, default, range, choices, label, group, key");
    command->add_flag(
        "--panel", *panel,
        "As JSON for a panel in another program: parameters, starts, styles with their values, derive ways");
    command->footer("Examples:\n  sgm params examples/tower.sgm\n  sgm params examples/tower.sgm --json");
    command->callback([file, json, panel, &exitCode] { exitCode = params(*file, *json, *panel); });
}

}  // namespace sgm::cli
