// sgm fmt: canonical layout.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/requests.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/rules/upgrade.h"
#include "grammar/syntax/parser.h"
#include "grammar/syntax/printer.h"
#include "modeler/core/atomic_file.h"

namespace sgm::cli {
namespace {

/// 0 when the file is (now) in canonical layout.
int formatOne(const std::string& file, bool checkOnly, bool upgrade) {
    const auto source = pipeline::readSource(file);
    if (!source.ok()) return fail(source.error());
    syntax::Diagnostics diagnostics;
    const syntax::Ast ast = syntax::parse(*source, operations::table(), diagnostics);
    printDiagnostics(diagnostics);
    if (diagnostics.hasErrors()) return 1;
    std::string text = syntax::format(**source, operations::table());
    if (upgrade && ast.version == 1) {
        const rules::Upgrade made = rules::upgraded(ast);
        syntax::Diagnostics notes;
        for (const syntax::Diagnostic& note : made.notes) notes.warning(note.span, note.message, note.hint);
        printDiagnostics(notes);
        text = syntax::format(syntax::Source(file, made.text), operations::table());
    }
    if (text == (*source)->text()) return 0;
    if (checkOnly) {
        fmt::print("{} is not formatted; run `sgm fmt {}`\n", file, file);
        return 1;
    }
    const Status written = writeFile(file, text);
    if (!written.ok()) return fail(written.error());
    fmt::print("formatted {}\n", file);
    return 0;
}

}  // namespace

void addFmt(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("fmt", "Lay out grammar files canonically; every comment stays");
    auto files = std::make_shared<std::vector<std::string>>();
    auto checkOnly = std::make_shared<bool>(false);
    command->add_option("FILE", *files, "Grammar files (.sgm)")->required();
    auto upgrade = std::make_shared<bool>(false);
    command->add_flag("--upgrade", *upgrade, "Rewrite files of 'grammar 1' as 'grammar 2', and report what differs");
    command->add_flag("--check", *checkOnly, "Change nothing; exit with 1 where a file is not formatted");
    command->footer("Examples:\n  sgm fmt my.sgm\n  sgm fmt --check *.sgm\n  sgm fmt --upgrade old.sgm");
    command->callback([files, checkOnly, upgrade, &exitCode] {
        for (const std::string& file : *files) exitCode = std::max(exitCode, formatOne(file, *checkOnly, *upgrade));
    });
}

}  // namespace sgm::cli
