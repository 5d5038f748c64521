// `sgm check` and `sgm build` agree: over mutants of all grammars, what one refuses the other does too.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "cli/requests.h"
#include "cli/trials.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/syntax/lexer.h"
#include "modeler/core/random.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;
constexpr uint64_t mostShapes = 4'000;

std::vector<fs::path> grammars() {
    std::vector<fs::path> files;
    for (const char* folder : {"examples", "grammar/std", "tests"})
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".sgm") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// A number that is rarely meant, in the unit of another.
std::string otherNumber(std::string_view number, uint64_t key) {
    constexpr std::string_view numbers[] = {"0", "1", "-1", "2", "7", "1000", ".001", ".5", "30", "-.2"};
    const size_t unit = number.find_first_not_of("0123456789.");
    return std::string(numbers[pick(key, std::size(numbers))]) +
           std::string(unit == number.npos ? std::string_view() : number.substr(unit));
}

/// The text with one to three of its numbers, names or signs replaced by others of the text or by numbers that are
/// rarely meant. Names of rules and of solids keep to themselves, so that many mutants can be read.
std::string mutant(const syntax::Source& source, uint64_t key) {
    const std::vector<syntax::Token> tokens = syntax::lexSignificant(source);
    const auto isUpper = [](std::string_view text) { return text[0] >= 'A' && text[0] <= 'Z'; };
    std::vector<std::pair<size_t, std::string>> edits;
    for (uint64_t i = 0; i < 1 + pick(combine(key, 1), 3); ++i) {
        const size_t at = pick(combine(key, 10 + i), tokens.size());
        const syntax::Token& other = tokens[pick(combine(key, 20 + i), tokens.size())];
        const std::string text(syntax::textOf(source, tokens[at])), instead(syntax::textOf(source, other));
        if (tokens[at].kind == syntax::Token::Kind::Number)
            edits.emplace_back(at, otherNumber(text, combine(key, 30 + i)));
        else if (other.kind == tokens[at].kind && !text.empty() && !instead.empty() &&
                 isUpper(text) == isUpper(instead))
            edits.emplace_back(at, instead);
    }
    std::sort(edits.begin(), edits.end());
    std::string text(source.text());
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
        const syntax::Token& token = tokens[edit->first];
        text.replace(token.begin, token.end - token.begin, edit->second);
    }
    return text;
}

/// What `sgm build` says of the first start at few cells: nothing where it passes.
std::string builtOf(std::shared_ptr<const rules::Grammar> grammar, bool& hasMesh) {
    pipeline::ModelChoice choice;
    choice.shapeBudget = mostShapes;
    const auto options = optionsFor(*grammar, choice);
    if (!options.ok()) return options.error().message;
    Context context{nullptr, 2};
    const auto model = makeModel(std::move(grammar), *options, context);
    if (!model.ok()) return model.error().message;
    GridRequest grid;
    grid.resolution = 32;
    grid.surface = mesh::Surface::Cubes;  // all that is asked is whether there are triangles
    grid.threads = 2;
    const auto mesh = makeMesh(*model, grid, context, true);
    hasMesh = mesh.ok() && mesh->mesh.triangleCount() > 0;
    return {};
}

/// The main model at such few shapes, and no others.
TrialOptions mainModelAlone() {
    TrialOptions options;
    options.model.shapeBudget = mostShapes;
    options.otherSeconds = 0;
    return options;
}

/// How a run over mutants went.
struct Tally {
    size_t made = 0, read = 0, refused = 0, empty = 0;
};

/// The grammar of a text; null where it can't be read: then both commands say the same, for both read it first.
std::shared_ptr<const rules::Grammar> readAs(const fs::path& file, const std::string& text,
                                             syntax::Diagnostics& diagnostics) {
    const auto source = std::make_shared<const syntax::Source>(file.string(), text);
    return rules::load(source, operations::table(), pipeline::fileLoader(), diagnostics);
}

/// A mutant that can be read, if one of a few can; else the last of them.
std::string readableMutant(const fs::path& file, const syntax::Source& source, uint64_t key) {
    constexpr uint64_t most = 12;
    std::string text;
    for (uint64_t k = 0; k < most; ++k) {
        text = mutant(source, combine(mix(key), k));
        syntax::Diagnostics diagnostics;
        if (text != source.text() && readAs(file, text, diagnostics)) break;
    }
    return text;
}

/// What `sgm check` and `sgm build` say of a text agrees, but for what `build` finds too thin for its cells.
void compare(const fs::path& file, const std::string& text, uint64_t number, Tally& tally) {
    ++tally.made;
    syntax::Diagnostics diagnostics;
    const auto grammar = readAs(file, text, diagnostics);
    if (!grammar) return;
    ++tally.read;
    const auto trials = tryModels(grammar, mainModelAlone(), nullptr, diagnostics);
    ASSERT_TRUE(trials.ok()) << trials.error().message;
    bool hasMesh = false;
    const std::string why = builtOf(grammar, hasMesh);
    tally.refused += !why.empty(), tally.empty += why.empty() && !hasMesh;
    std::string told;
    for (const syntax::Diagnostic& d : diagnostics.all())
        if (d.severity == syntax::Severity::Error) told += d.message;
    const auto show = [&] { return std::getenv("SGM_MUTANTS") ? "\n" + text : std::string(); };
    EXPECT_TRUE(why.empty() || !told.empty()) << file << " mutant " << number << ": build says " << why << show();
    EXPECT_TRUE(!hasMesh || told.empty()) << file << " mutant " << number << ": check says " << told << show();
}

/// As many mutants as SGM_MUTANTS says, else a few, of all grammars alike.
TEST(Agreement, CheckPassesWhereBuildDoes) {
    const char* const wanted = std::getenv("SGM_MUTANTS");
    const std::vector<fs::path> files = grammars();
    const uint64_t all = wanted ? std::strtoull(wanted, nullptr, 10) : files.size() + 100;
    Tally tally;
    for (size_t i = 0; i < files.size(); ++i) {
        const auto original = pipeline::readSource(files[i]);
        ASSERT_TRUE(original.ok());
        const uint64_t each = all / files.size() + (i < all % files.size());
        for (uint64_t k = 0; k < each; ++k)
            compare(files[i],
                    k == 0 ? std::string((*original)->text()) : readableMutant(files[i], **original, combine(i, k)), k,
                    tally);
    }
    std::printf("%zu mutants: %zu could be read, %zu refused by both, %zu without surface at 32 cells\n", tally.made,
                tally.read, tally.refused, tally.empty);
    EXPECT_EQ(tally.made, all);
    EXPECT_GT(tally.read, 0u);
}

/// A mutant of std/cave.sgm ended the program: a number stood where a direction is inherited.
TEST(Agreement, ADirectionThatIsANumberIsAnError) {
    for (const char* rule : {"+ cube at d", "+ cube at +x to d"}) {
        syntax::Diagnostics diagnostics;
        const auto grammar = readAs("direction.sgm",
                                    "grammar 1\nstart A -> cube with d = +x : B\n"
                                    "rule B -> + cube at d with d = 7 : C\nrule C -> " +
                                        std::string(rule) + "\n",
                                    diagnostics);
        ASSERT_TRUE(grammar);
        ASSERT_TRUE(tryModels(grammar, mainModelAlone(), nullptr, diagnostics).ok());
        bool told = false;
        for (const syntax::Diagnostic& d : diagnostics.all())
            told = told || d.message.find("'d' is 7 here, and a joint is a direction") != std::string::npos;
        EXPECT_TRUE(told) << rule;
        bool hasMesh = false;
        EXPECT_NE(builtOf(grammar, hasMesh).find("'d' is 7 here"), std::string::npos) << rule;
    }
}

}  // namespace
}  // namespace sgm::cli
