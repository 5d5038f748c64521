// What a shell and a manual know of the program, and grammars to begin with.
#include <set>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Shell : public Cli {
protected:
    /// What bash offers for the last of these words.
    std::set<std::string> completed(const std::string& words) {
        const std::string script = path("complete.bash");
        EXPECT_EQ(sgm("completion bash > " + script).code, 0);
        const std::string run = "bash -c '. " + script + "; COMP_WORDS=(" + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _sgm; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
        FILE* pipe = popen(run.c_str(), "r");
        std::string out;
        char buffer[4096];
        for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) out.append(buffer, n);
        EXPECT_EQ(pclose(pipe), 0) << out;
        std::set<std::string> found;
        std::istringstream lines(out);
        for (std::string line; std::getline(lines, line);)
            if (!line.empty()) found.insert(line);
        return found;
    }
};

TEST_F(Shell, BashCompletesCommandsOptionsChoicesAndFiles) {
    EXPECT_TRUE(completed("sgm bu").contains("build"));
    EXPECT_FALSE(completed("sgm bu").contains("check"));
    EXPECT_TRUE(completed("sgm build --res").contains("--resolution"));
    EXPECT_FALSE(completed("sgm params --res").contains("--resolution"));
    EXPECT_EQ(completed("sgm build --surface \"\""), (std::set<std::string>{"crisp", "cubes"}));
    EXPECT_TRUE(completed("sgm build examples/tow").contains("examples/tower.sgm"));
    EXPECT_FALSE(completed("sgm build READ").contains("README.md"));
}

TEST_F(Shell, EveryCommandAndOptionIsInEveryScript) {
    const std::string help = sgm("build --help").out;
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const Outcome script = sgm(std::string("completion ") + shell);
        ASSERT_EQ(script.code, 0);
        for (const char* word : {"build", "render", "lsp", "resolution", "surface", "crisp cubes", "try-seconds"})
            EXPECT_NE(script.out.find(word), std::string::npos) << shell << " " << word;
        const std::string check = std::string("command -v ") + shell + " > /dev/null";
        if (std::system(check.c_str()) != 0) {
            std::printf("%s isn't installed: its script isn't read\n", shell);
            continue;
        }
        const std::string file = path(shell);
        std::ofstream(file) << script.out;
        EXPECT_EQ(std::system((std::string(shell) + " -n " + file).c_str()), 0);
    }
    EXPECT_EQ(sgm("completion tcsh").code, 2);
}

TEST_F(Shell, TheManualPageIsReadWithoutAWarning) {
    const Outcome page = sgm("man");
    ASSERT_EQ(page.code, 0);
    EXPECT_NE(page.out.find(".SH SGM BUILD"), std::string::npos) << page.out.substr(0, 600);
    EXPECT_NE(page.out.find("\\-\\-resolution"), std::string::npos);
    if (std::system("command -v man > /dev/null") != 0) GTEST_SKIP() << "man isn't installed";
    std::ofstream(path("sgm.1")) << page.out;
    const std::string warnings = path("warnings");
    EXPECT_EQ(std::system(("LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l " + path("sgm.1") + " > " + path("shown") +
                           " 2> " + warnings)
                              .c_str()),
              0);
    EXPECT_EQ(read(warnings), "");
    EXPECT_NE(read(path("shown")).find("--resolution"), std::string::npos);
}

TEST_F(Shell, NewGrammarsAreWholeAndReplaceNothing) {
    for (const char* kind : {"tower", "facade", "cave"}) {
        const std::string file = path(std::string(kind) + ".sgm");
        const Outcome made = sgm(std::string("new --template ") + kind + " " + path(kind));
        ASSERT_EQ(made.code, 0) << made.out;
        const Outcome checked = sgm("check " + file);
        EXPECT_EQ(checked.out, file + ": fine\n");
        EXPECT_EQ(sgm("fmt --check " + file).code, 0) << sgm("fmt " + file).out;
        const std::string before = read(file);
        EXPECT_EQ(sgm("new " + file).code, 1);
        EXPECT_EQ(read(file), before);
        EXPECT_EQ(before.find("NAME"), std::string::npos);
    }
    EXPECT_EQ(sgm("new x --template castle").code, 2);
    EXPECT_EQ(sgm("new /nowhere/at/all").code, 1);
}

TEST_F(Shell, ExamplesAreListedAndCopiedWithWhatTheyUse) {
    const Outcome list = sgm("examples");
    EXPECT_NE(list.out.find("tower.sgm"), std::string::npos);
    EXPECT_NE(list.out.find("buildings/palace.sgm"), std::string::npos);
    EXPECT_NE(list.out.find("A palace of three tall storeys"), std::string::npos);
    ASSERT_EQ(sgm("examples knot --to " + path("copy")).code, 0);
    EXPECT_TRUE(fs::exists(path("copy/meshes/knot.obj")));
    EXPECT_EQ(sgm("check " + path("copy/knot.sgm")).code, 0);
    const Outcome again = sgm("examples knot --to " + path("copy"));
    EXPECT_EQ(again.code, 1);
    EXPECT_NE(again.out.find("is there already"), std::string::npos);
    EXPECT_NE(sgm("examples towerr").out.find("did you mean 'tower'?"), std::string::npos);
}

}  // namespace
}  // namespace sgm::cli
