// The broken grammars of tests/bad: each must say exactly what its .expected file holds. To rewrite those files after a
// change of wording, run this program with SGM_REWRITE_EXPECTED=1 and read the difference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "grammar/operations/operations.h"
#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

namespace fs = std::filesystem;
const fs::path folder = "tests/bad";

std::vector<std::string> grammars() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".sgm") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// Names are relative to the folder, so that the expected text doesn't depend on where the tests run.
std::string said(const std::string& name) {
    std::vector<syntax::SourcePtr> kept;
    Loader loader([&](const std::string& wanted, const syntax::Source& from, std::string& why) -> syntax::SourcePtr {
        const fs::path path = (fs::path(from.name()).parent_path() / wanted).lexically_normal();
        if (*path.begin() == "..")
            why = "a grammar may only use files in its own folder or in std/";
        else if (!fs::exists(folder / path))
            why = "there is no such file";
        else {
            kept.push_back(std::make_shared<const syntax::Source>(path.string(), readText((folder / path).string())));
            return kept.back();
        }
        return nullptr;
    });
    loader.mesh = [](const std::string&, const syntax::Source&, std::string& why) {
        why = "there is no such file";
        return nullptr;
    };
    const auto source =
        std::make_shared<const syntax::Source>(name + ".sgm", readText((folder / (name + ".sgm")).string()));
    syntax::Diagnostics diagnostics;
    const auto grammar = load(source, operations::table(), loader, diagnostics);
    EXPECT_FALSE(grammar);
    EXPECT_TRUE(diagnostics.hasErrors());
    std::string text;
    for (const syntax::Diagnostic& d : diagnostics.all()) text += syntax::render(d) + "\n";
    return text;
}

class Bad : public testing::TestWithParam<std::string> {};

TEST_P(Bad, SaysWhatIsExpected) {
    const std::string file = (folder / (GetParam() + ".expected")).string();
    const std::string text = said(GetParam());
    if (std::getenv("SGM_REWRITE_EXPECTED")) std::ofstream(file, std::ios::binary) << text;
    EXPECT_EQ(text, readText(file));
}

INSTANTIATE_TEST_SUITE_P(Grammar, Bad, testing::ValuesIn(grammars()), [](const auto& test) {
    std::string name = "n" + test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(BadGrammars, AreFortyOrMore) { EXPECT_GE(grammars().size(), 40u); }

}  // namespace
}  // namespace sgm::rules
