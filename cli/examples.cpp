// sgm new and sgm examples: grammars to begin with.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/requests.h"
#include "cli/validators.h"
#include "grammar/language/words.h"
#include "grammar/pipeline/files.h"
#include "grammar/syntax/lexer.h"
#include "modeler/core/atomic_file.h"

namespace sgm::cli {
namespace fs = std::filesystem;
namespace {

struct Template {
    const char* name;
    const char* text;  ///< NAME stands for the grammar's own
};

constexpr Template templates[] = {
    {"tower", R"(grammar 2
// NAME: storeys that grow one on another.
use "std/walls.sgm"

param floors = 6  in 2..30   "Storeys"      group House
param width  = 8m in 4m..20m "Ground floor" group House

start House -> stone size (width, 3, width) : Storey
rule Storey repeat floors - 1
  -> + stone size ((width ~> width / 2), 3, (width ~> width / 2)) at +y : Storey
  finally + roof(.3) size (60%, 3, 60%) on last at +y color #a4503a

check House { floors = 3 } expect bonds >= 3
)"},
    {"facade", R"(grammar 2
// NAME: a wall, split into storeys and bays with windows.
use "std/walls.sgm"

param bay    = 2.4m in 1m..6m "Width of a bay" group Front
param storey = 3m   in 2m..6m "Height"         group Front

start Front -> size (14, 12, .5) split y { { ~storey: Row }* }
rule Row -> split x { { ~bay: Tile }* }
rule Tile -> split x { ~1: brick | ~2: Window | ~1: brick }
rule Window -> split y { ~1: brick | ~2: glass size (100%, 100%, 30%) | ~1: brick }
)"},
    {"cave", R"(grammar 2
// NAME: hollows that merge, a cell at a time.
param cells = 12 in 2..60 "Cells"

start Cave -> sphere size 4 color #8a8072 : Cell
rule Cell repeat cells - 1
  -> + morph(sphere, cube, .2..(.6)) size 4 ~> 2 at free(+x, -x, +z) to centre
     shift (0, -.2..(.2), 0) blend .4m : Cell
)"},
};

/// The examples stand beside the installed program, or in the tree it was built from.
fs::path examplesFolder() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    const fs::path installed = program.parent_path().parent_path() / "share/sgm/examples";
    return fs::is_directory(installed, ignored) ? installed : fs::path(SGM_EXAMPLES);
}

std::string titleOf(const std::string& stem) {
    std::string title = stem;
    if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
    return title;
}

int writeNew(const std::string& name, const std::string& kind) {
    fs::path path = name;
    if (path.extension() != ".sgm") path += ".sgm";
    std::error_code ignored;
    if (fs::exists(path, ignored))
        return fail({Error::Kind::Input, fmt::format("'{}' is there already; name another file", path.string())});
    const auto* const chosen =
        std::find_if(std::begin(templates), std::end(templates), [&](const Template& t) { return t.name == kind; });
    std::string text = chosen->text;
    text.replace(text.find("NAME"), 4, titleOf(path.stem().string()));
    const Status written = writeFile(path, text);
    if (!written.ok()) return fail(written.error());
    const auto inShell = [](const std::string& word) {
        const bool isPlain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
            return std::isalnum(c) || c > 127 || c == '_' || c == '-' || c == '.' || c == '/';
        });
        return isPlain ? word : fmt::format("\"{}\"", word);
    };
    fmt::print("wrote {0}\nsgm view {1}                     see it and change it\nsgm build {1} -o {2}     build it\n",
               path.string(), inShell(path.string()), inShell(path.stem().string() + ".glb"));
    return 0;
}

std::vector<fs::path> examples() {
    std::vector<fs::path> files;
    std::error_code failed;
    for (fs::recursive_directory_iterator it(examplesFolder(), failed), end; !failed && it != end; it.increment(failed))
        if (it->path().extension() == ".sgm") files.push_back(fs::relative(it->path(), examplesFolder()));
    std::sort(files.begin(), files.end());
    return files;
}

std::string purposeOf(const fs::path& path) {
    const auto source = pipeline::readSource(path);
    return source.ok() ? language::purposeOf(**source) : std::string();
}

/// What a grammar of the examples reads beside itself, itself first: by `use` and `mesh` and `file`, in its own folder.
std::vector<fs::path> withFiles(const fs::path& example) {
    std::vector<fs::path> all{example};
    for (size_t i = 0; i < all.size(); ++i) {
        const auto source = all[i].extension() == ".sgm" ? pipeline::readSource(examplesFolder() / all[i])
                                                         : Result<syntax::SourcePtr>(Error{});
        if (!source.ok()) continue;
        for (const syntax::Token& token : syntax::lex(**source)) {
            const std::string_view text = textOf(**source, token);
            if (token.kind != syntax::Token::Kind::Text || text.size() < 3) continue;
            const fs::path named =
                (all[i].parent_path() / std::string(text.substr(1, text.size() - 2))).lexically_normal();
            std::error_code ignored;
            const bool there = fs::is_regular_file(examplesFolder() / named, ignored) && *named.begin() != "..";
            if (there && std::find(all.begin(), all.end(), named) == all.end()) all.push_back(named);
        }
    }
    return all;
}

int copyExample(const std::string& name, const fs::path& folder) {
    const std::vector<fs::path> all = examples();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const fs::path& p) { return p == name || p.stem() == name; });
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const fs::path& p : all) names.push_back(p.stem().string());
        const std::string near = syntax::didYouMean(name, names);
        return fail({Error::Kind::Input,
                     fmt::format("no example '{}'{}", name,
                                 near.empty() ? ": `sgm examples` lists them" : "; did you mean '" + near + "'?")});
    }
    const std::vector<fs::path> files = withFiles(*found);
    const fs::path base = found->parent_path();
    const auto targetOf = [&](const fs::path& file) { return folder / file.lexically_relative(base); };
    std::error_code failed;
    for (const fs::path& file : files)
        if (fs::exists(targetOf(file), failed))
            return fail({Error::Kind::Input, fmt::format("'{}' is there already: copy into another folder with --to",
                                                         targetOf(file).string())});
    for (const fs::path& file : files) {
        fs::create_directories(targetOf(file).parent_path().empty() ? "." : targetOf(file).parent_path(), failed);
        if (!fs::copy_file(examplesFolder() / file, targetOf(file), failed))
            return fail(
                {Error::Kind::Input, fmt::format("can't write '{}': {}", targetOf(file).string(), failed.message())});
        fmt::print("wrote {}\n", targetOf(file).string());
    }
    return 0;
}

int listExamples() {
    for (const fs::path& path : examples()) fmt::print("{:32} {}\n", path.string(), purposeOf(examplesFolder() / path));
    return 0;
}

}  // namespace

void addExamples(CLI::App& app, int& exitCode) {
    CLI::App* fresh = app.add_subcommand("new", "Write a grammar to begin with");
    auto name = std::make_shared<std::string>(), kind = std::make_shared<std::string>(templates[0].name);
    fresh->add_option("NAME", *name, "Its name: NAME.sgm is written")->required();
    std::vector<std::string> kinds;
    for (const Template& t : templates) kinds.emplace_back(t.name);
    fresh->add_option("--template", *kind, "What it begins as")->check(oneOf(kinds))->capture_default_str();
    fresh->footer(fmt::format("Examples:\n  sgm new my\n  sgm new my --template {}", templates[1].name));
    fresh->callback([name, kind, &exitCode] { exitCode = writeNew(*name, *kind); });

    CLI::App* list = app.add_subcommand("examples", "List the examples, or copy one with what it uses");
    auto example = std::make_shared<std::string>(), folder = std::make_shared<std::string>(".");
    list->add_option("NAME", *example, "The example to copy");
    list->add_option("--to", *folder, "Folder to copy it into")->capture_default_str();
    list->footer("Examples:\n  sgm examples\n  sgm examples tower --to models");
    list->callback([example, folder, &exitCode] {
        exitCode = example->empty() ? listExamples() : copyExample(*example, *folder);
    });
}

}  // namespace sgm::cli
