// sgm reference: the page docs/reference.md, written from the tables that the program itself runs on.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "cli/commands.h"
#include "grammar/language/textmate.h"
#include "grammar/language/tree_sitter.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/roads.h"
#include "grammar/rules/type.h"
#include "grammar/syntax/operations.h"
#include "grammar/syntax/parser.h"
#include "modeler/export/exporter.h"
#include "modeler/field/primitives.h"

namespace sgm::cli {
namespace {

std::string argumentList(const syntax::Operation& operation) {
    std::string text;
    for (const syntax::OperationArgument& a : operation.arguments) {
        const std::string argument = a.word.empty() ? std::string(a.name) : fmt::format("{} {}", a.word, a.name);
        text += a.optional ? fmt::format(" [{}]", argument) : " " + argument;
    }
    return text;
}

std::string operationsPage() {
    std::string page = "## Rule operations\n\nWhat a rule body may do to a shape.\n";
    for (const syntax::Operation* row : operations::table().rows()) {
        const syntax::Operation& o = *row;
        page += fmt::format("\n### `{}{}{}`\n\n{}\n", o.name, argumentList(o),
                            o.hasBlock() || o.traits.takesSettings ? " { … }" : "", o.doc);
        for (const syntax::OperationArgument& a : o.arguments) page += fmt::format("- `{}`: {}\n", a.name, a.doc);
        if (!o.example.empty()) page += fmt::format("\n    {}\n", o.example);
    }
    return page;
}

/// What `footprint` draws by name.
std::string plansPage() {
    std::string page =
        "\n## Plans\n\nWhat `footprint` draws, besides `outline((x, z), …)` and an lsystem. Each takes `at: (x, z)` "
        "and `turn: angle`.\n";
    for (const rules::PlanRow& row : rules::planRows()) {
        page += fmt::format("\n### `{}`\n\n{}\n", row.name, row.doc);
        for (const rules::PlanParameter& p : row.parameters)
            page += fmt::format("- `{}`: {}{}\n", p.name, p.doc, p.required ? "" : " (may be left out)");
        page += fmt::format("\n    {}\n", row.example);
    }
    return page;
}

std::string rowOf(std::string_view name, const std::string& value, std::string_view doc) {
    return fmt::format("| `{}` | {} | {} |\n", name, value, doc);
}

/// The default of a road's number, in its unit.
std::string fallbackOf(const town::RoadParameter& row) {
    using Unit = town::RoadParameter::Unit;
    const double v = town::RoadParameters{}.*row.field;
    if (row.unit == Unit::Angle) return fmt::format("{:.3g}deg", v * 180 / 3.14159265358979323846);
    if (row.unit == Unit::Share) return fmt::format("{:.3g}%", v * 100);
    return fmt::format("{:.6g}{}", v, row.unit == Unit::Length ? "m" : "");
}

/// The settings of `roads`.
std::string roadsPage() {
    std::string page =
        "\n## Roads\n\nWhat `roads NAME { setting = value … }` may set; `network NAME` grows them.\n\n| setting | "
        "value | "
        "|\n|---|---|---|\n";
    for (const rules::RoadField& row : rules::roadFields())
        page += rowOf(row.name, fmt::format("{}, asked everywhere", describe(row.want)), row.doc);
    for (const rules::RoadField& row : rules::roadPoints()) page += rowOf(row.name, "a place (x, z)", row.doc);
    for (const rules::RoadWord& row : rules::roadWords())
        page += rowOf(row.name, fmt::format("`{}`", fmt::join(row.words, "`, `")), row.doc);
    for (const town::RoadParameter& row : town::roadParameters())
        page += rowOf(row.name, fmt::format("{}, in {}", fallbackOf(row), row.range), row.doc);
    return page;
}

/// "ball|cube" as "`ball`, `cube`".
std::string listed(std::string_view choices) {
    std::string text = "`";
    for (const char c : choices) text += c == '|' ? std::string("`, `") : std::string(1, c);
    return text + "`";
}

std::string parameterText(const field::PrimitiveParameter& p) {
    using Kind = field::ParameterKind;
    if (p.kind == Kind::Choice) return fmt::format("one of {}", listed(p.choices));
    if (p.kind == Kind::File) return "a file's name, in quotes";
    if (p.kind == Kind::Rotation) return "a rotation: rotX(a), rotY(a), rotZ(a)";
    if (p.kind == Kind::Point && p.optional) return "a point, or left out";
    const char* each = p.kind == Kind::PerId ? "one or four, " : "";
    const bool angle = p.kind == Kind::Angle;
    const double unit = angle ? 180 / 3.14159265358979323846 : 1;
    const char* name = angle ? "deg" : p.kind == Kind::Length || p.kind == Kind::Point ? "m" : "";
    return fmt::format("{}{:.4g}{} in {:.4g}{}..{:.4g}{}", each, p.fallback * unit, name, p.lo * unit, name,
                       p.hi * unit, name);
}

std::string primitivesPage() {
    std::string page =
        "\n## Primitives\n\nA solid fills its scope. Every one has the joints `+x -x +y -y +z -z` and `centre`.\n";
    for (const field::Primitive& row : field::primitives()) {
        page +=
            fmt::format("\n### `{}`\n\n{}{}\n", row.name, row.doc, row.bounded ? "" : " Unbounded: it may only cut.");
        if (!row.parameters.empty()) page += "\n| parameter | default and range | |\n|---|---|---|\n";
        for (const field::PrimitiveParameter& p : row.parameters)
            page += fmt::format("| `{}` | {} | {} |\n", p.name, parameterText(p), p.doc);
        for (const field::PrimitiveJoint& j : row.joints)
            page += fmt::format("\nJoint `{}` at ({:.3g}, {:.3g}, {:.3g}) of the half-size.\n", j.name, j.at.x, j.at.y,
                                j.at.z);
    }
    return page;
}

std::string functionsPage() {
    std::string page = "\n## Functions\n\nWhat an expression may call.\n\n| function | arguments | |\n|---|---|---|\n";
    for (const rules::Function& f : rules::functions())
        page += fmt::format("| `{}` | {} | {} |\n", f.name,
                            f.least == f.most ? fmt::format("{}", f.least)
                            : f.most == 255   ? fmt::format("{} or more", f.least)
                                              : fmt::format("{} to {}", f.least, f.most),
                            f.doc);
    return page;
}

std::string exportersPage() {
    std::string page =
        "\n## File formats\n\n`sgm build FILE -o NAME.ENDING`; options by `--format-option NAME=VALUE`.\n\n| ending | "
        "| options |\n|---|---|---|\n";
    for (const exporter::Exporter& e : exporter::exporters()) {
        std::string options;
        for (const exporter::ExportOption& o : e.options)
            options += fmt::format("{}`{}={}`: {}{}", options.empty() ? "" : "<br>", o.name, o.fallback, o.doc,
                                   !o.choices.empty() ? fmt::format(" ({})", listed(o.choices))
                                   : o.lo < o.hi      ? fmt::format(" ({} to {})", o.lo, o.hi)
                                                      : "");
        page += fmt::format("| `{}` | {} | {} |\n", e.extension, e.doc, options);
    }
    return page;
}

/// Names in backticks, each once, in their order.
std::string namesOf(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < names.size(); ++i)
        if (std::find(names.begin(), names.begin() + static_cast<ptrdiff_t>(i), names[i]) ==
            names.begin() + static_cast<ptrdiff_t>(i))
            text += fmt::format("{}`{}`", text.empty() ? "" : " ", names[i]);
    return text;
}

/// What the files of `std/` define.
std::string libraryPage() {
    std::string page =
        "\n## Standard library\n\nThe names that `use \"std/…\"` brings. A grammar that uses a file can't give "
        "them to parameters, terminals or rules of its own.\n\n| file | uses | rules | terminals | parameters "
        "|\n|---|---|---|---|---|\n";
    for (const auto& [name, source] : pipeline::standardFiles()) {
        syntax::Diagnostics ignored;
        const syntax::Ast ast = syntax::parse(source, operations::table(), ignored);
        std::vector<std::string> uses, rules, terminals, params;
        for (const auto& d : ast.uses) uses.push_back(d.file.text);
        for (const auto& d : ast.rules) rules.push_back(d.symbol.text);
        for (const auto& d : ast.terminals)
            for (const syntax::Name& n : d.names) terminals.push_back(n.text);
        for (const auto& d : ast.params) params.push_back(d.name.text);
        page += fmt::format("| `{}` | {} | {} | {} | {} |\n", name, namesOf(uses), namesOf(rules), namesOf(terminals),
                            namesOf(params));
    }
    return page;
}

}  // namespace

void addReference(CLI::App& app, int& exitCode) {
    CLI::App* command =
        app.add_subcommand("reference", "Print the reference page: operations, primitives, functions, formats");
    auto textMate = std::make_shared<bool>(false);
    command->add_flag("--textmate", *textMate, "Print a TextMate grammar instead, for editors that highlight by one");
    auto treeSitter = std::make_shared<bool>(false);
    command->add_flag("--tree-sitter", *treeSitter, "Print a tree-sitter grammar instead, the input of its generator");
    command->footer("Examples:\n  sgm reference > reference.md\n  sgm reference --textmate > sgm.tmLanguage.json");
    command->callback([textMate, treeSitter, &exitCode] {
        if (*textMate || *treeSitter) {
            fmt::print("{}", *textMate ? language::textMateGrammar() : language::treeSitterGrammar());
            return;
        }
        fmt::print("# Reference\n\nPrinted by `sgm reference` from the program's own tables.\n\n{}{}{}{}{}{}{}",
                   operationsPage(), plansPage(), roadsPage(), primitivesPage(), functionsPage(), exportersPage(),
                   libraryPage());
        exitCode = 0;
    });
}

}  // namespace sgm::cli
