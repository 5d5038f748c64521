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
    for (const auto& entry : fs::recursive_directory_iterator("examples"))
        if (entry.path().extension() == ".sgm") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// The text with one to three of its numbers, names or signs replaced by others of the text or by numbers that are
/// rarely meant.
std::string mutant(const syntax::Source& source, uint64_t key) {
    const std::vector<syntax::Token> tokens = syntax::lexSignificant(source);
    constexpr std::string_view numbers[] = {"0",    "1",  "-1",  "2",     "7",         "1000",
                                            ".001", "3m", "50%", "90deg", "(1, 2, 3)", "#808080"};
    std::vector<std::pair<size_t, std::string>> edits;
    for (uint64_t i = 0; i < 1 + pick(combine(key, 1), 3); ++i) {
        const size_t at = pick(combine(key, 10 + i), tokens.size());
        const syntax::Token& other = tokens[pick(combine(key, 20 + i), tokens.size())];
        if (tokens[at].kind == syntax::Token::Kind::Number)
            edits.emplace_back(at, numbers[pick(combine(key, 30 + i), std::size(numbers))]);
        else if (other.kind == tokens[at].kind)
            edits.emplace_back(at, syntax::textOf(source, other));
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
    grid.threads = 2;
    const auto mesh = makeMesh(*model, grid, context, true);
    hasMesh = mesh.ok() && mesh->mesh.triangleCount() > 0;
    return {};
}

TEST(Agreement, CheckPassesWhereBuildDoes) {
    const char* const wanted = std::getenv("SGM_MUTANTS");
    const uint64_t each = wanted ? std::strtoull(wanted, nullptr, 10) : 2;
    size_t read = 0, refused = 0, empty = 0;
    for (const fs::path& file : grammars()) {
        const auto original = pipeline::readSource(file);
        ASSERT_TRUE(original.ok());
        for (uint64_t k = 0; k < each; ++k) {
            const std::string text =
                k == 0 ? std::string((*original)->text()) : mutant(**original, combine(mix(k), pick(k, 1000)));
            const auto source = std::make_shared<const syntax::Source>(file.string(), text);
            syntax::Diagnostics diagnostics;
            const auto grammar = rules::load(source, operations::table(), pipeline::fileLoader(), diagnostics);
            if (!grammar) continue;
            ++read;
            const auto trials = tryModels(grammar, {1, 60, mostShapes, 0}, nullptr, diagnostics);
            ASSERT_TRUE(trials.ok()) << trials.error().message;
            bool hasMesh = false;
            const std::string why = builtOf(grammar, hasMesh);
            refused += !why.empty(), empty += why.empty() && !hasMesh;
            std::string told;
            for (const syntax::Diagnostic& d : diagnostics.all())
                if (d.severity == syntax::Severity::Error) told += d.message;
            EXPECT_TRUE(why.empty() || !told.empty()) << file << " mutant " << k << ": build says " << why;
            EXPECT_TRUE(!hasMesh || told.empty()) << file << " mutant " << k << ": check says " << told;
        }
    }
    RecordProperty("read", static_cast<int>(read));
    std::printf("%zu mutants were read, %zu refused by both, %zu without surface at 32 cells\n", read, refused, empty);
    EXPECT_GT(read, 0u);
}

}  // namespace
}  // namespace sgm::cli
