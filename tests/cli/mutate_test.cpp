// `sgm mutate`: degenerate variations are left out, the same sheet comes again, and the chosen one written back as a
// style is the same model. And what goes with facades: --keep and --view ids.

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

/// A grammar whose word `kind` makes one sound model and one degenerate.
std::string planted(const std::string& bad) {
    return "param kind = good of good, bad\nparam width = 4 in 2..8.0\n"
           "start House -> Part\nrule Part when kind == bad -> " +
           bad + "\nrule Part -> sphere size (width, 3, 3)\n";
}

TEST_F(Cli, MutateLeavesDegeneratesOut) {
    const std::pair<const char*, const char*> degenerates[] = {
        {"cube size .4 & cube size .4 move (9, 0, 0)", "empty"},
        {"sphere size .4 for k in 1..12 { + sphere size .4 move (k, k % 2, 0) }", "dust"},
        {"sphere size 3 + sphere size 2 move (0, 6, 0)", "floating"},
        {"cube size 4 + cube size (8, 4, 2)", "featureless"}};
    for (const auto& [bad, why] : degenerates) {
        SCOPED_TRACE(why);
        const Outcome run = sgm("mutate " + grammar(planted(bad)) + " --rows 2 --cols 4 --spread 1");
        EXPECT_EQ(run.code, 0) << run.out;
        EXPECT_NE(run.out.find(std::string(": ") + why), std::string::npos) << run.out;
        EXPECT_EQ(run.out.find("kind=bad"), std::string::npos) << run.out;
        EXPECT_NE(run.out.find("7: width="), std::string::npos) << run.out;
    }
}

TEST_F(Cli, MutateWritesTheChosenOneBack) {
    const std::string file = grammar(
        "param width = 4 in 2..8.0\nparam rounds = .5 in 0..1.0\nparam high = 3m in 1m..9m  // kept\n"
        "start House -> morph(cube, sphere, rounds) size (width, high, 3)\n");
    const std::string before = read(file),
                      command = "mutate " + file + " --rows 1 --cols 4 --resolution 32 --lock high";
    const Outcome list = sgm(command);
    ASSERT_EQ(list.code, 0) << list.out;
    EXPECT_EQ(read(file), before) << "nothing is written without --pick";
    EXPECT_EQ(list.out.find("high="), std::string::npos) << "a locked parameter stays";
    const size_t line = list.out.find("3: ");
    ASSERT_NE(line, std::string::npos);
    std::string settings;
    std::istringstream words(list.out.substr(line + 3, list.out.find('\n', line) - line - 3));
    for (std::string word; words >> word;) settings += " --set " + word;
    ASSERT_EQ(sgm("build " + file + settings + " --resolution 32 -o " + path("a.ply")).code, 0);

    const Outcome kept = sgm(command + " --pick 3 --save Lucky");
    ASSERT_EQ(kept.code, 0) << kept.out;
    EXPECT_EQ(read(file).substr(0, before.size()), before) << "comments and layout stay";
    const Outcome again = sgm("build " + file + " --style Lucky --resolution 32 -o " + path("b.ply"));
    ASSERT_EQ(again.code, 0) << again.out;
    EXPECT_EQ(read(path("a.ply")), read(path("b.ply")));
    const Outcome twice = sgm(command + " --pick 1 --save Lucky");
    EXPECT_EQ(twice.code, 1);
    EXPECT_NE(twice.out.find("there is a style 'Lucky' already: save under another name"), std::string::npos)
        << twice.out;
}

TEST_F(Cli, MutateShowsNothingTwice) {
    const std::string file = grammar(
        "param n = 1 in 1..4\nstart A -> cube : B\nrule B repeat n -> + sphere size .8 at free(+x, +y, +z) overlap .4 "
        ": B\n");
    const Outcome run = sgm("mutate " + file + " --rows 3 --cols 4 --spread 1 --resolution 32");
    ASSERT_EQ(run.code, 0) << run.out;
    for (const char* line : {"0: as it is\n", " n=2\n", " n=3\n", " n=4\n", ": the same as another\n"}) {
        const size_t at = run.out.find(line);
        ASSERT_NE(at, std::string::npos) << line << run.out;
        EXPECT_EQ(run.out.find(line, at + 1), std::string::npos) << line << run.out;
    }
}

TEST_F(Cli, MutateJudgesAlikeAtAnyResolution) {
    const std::string part = grammar(
        "param bare = false\nparam width = 4 in 2..8.0\nstart House -> Mass\nrule Mass when bare -> cube size (width, "
        "3, "
        "3) + cube size (3, 3, width) + cube size (1.7, 5, 1.3) turn 20deg\nrule Mass -> sphere size (width, 3, 3)\n");
    for (const char* cells : {"24", "64", "160"})
        EXPECT_NE(sgm("mutate " + part + " --rows 2 --cols 3 --spread 1 --resolution " + cells).out.find("featureless"),
                  std::string::npos)
            << cells;
    const std::string clad = grammar(
        "use \"std/kifs.sgm\"\nparam width = 12m in 8m..16m\nstart House -> Box size (width, 8, 8) clad casement\n");
    for (const char* cells : {"24", "64", "160"})
        EXPECT_TRUE(sgm("mutate " + clad + " --rows 1 --cols 1 --resolution " + cells)
                        .out.ends_with("note: nothing was drawn: add -o sheet.png\n0: as it is\n"))
            << cells;  // behind what crumbles at such cells
}

TEST_F(Cli, MutateSeesGapsThatNeedHalvedCells) {
    const std::string bad = "cube size (8, 3, 8) + cube size (8, 3, 8) move (0, 3.1, 0) + sphere size 5 move (0, 5, 0)";
    const std::string file = grammar(planted(bad));
    const std::string mesh = file + " --set kind=bad --resolution 24";
    ASSERT_EQ(built(mesh + " --halvings 0")["mesh"]["components"], 1);
    ASSERT_EQ(built(mesh)["mesh"]["components"], 2);
    const Outcome run = sgm("mutate " + file + " --rows 2 --cols 3 --spread 1 --resolution 24");
    EXPECT_NE(run.out.find(": floating"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("kind=bad"), std::string::npos) << run.out;
}

TEST_F(Cli, MutateSaysWhatIsWrong) {
    const std::string file = grammar("param width = 4 in 2..8.0\nstart House -> sphere size (width, 3, 3)\n");
    EXPECT_EQ(sgm("mutate " + file + " --pick 1").code, 2);
    EXPECT_EQ(sgm("mutate " + file + " --rows 1 --cols 2 --pick 7 --save A").code, 2);
    EXPECT_EQ(sgm("mutate " + file + " --lock nothing").code, 2);
    EXPECT_NE(sgm("mutate " + file + " --lock widht").out.find("did you mean 'width'?"), std::string::npos);
    EXPECT_NE(sgm("mutate " + file + " --lock nope").out.find("there are width"), std::string::npos);
    const Outcome spaced = sgm("mutate " + file + " --pick 1 --save 'my style'");
    EXPECT_EQ(spaced.code, 2);
    EXPECT_NE(spaced.out.find("--save 'my style': the name of a style is letters"), std::string::npos) << spaced.out;
    const Outcome locked = sgm("mutate " + file + " --lock width");
    EXPECT_EQ(locked.code, 1);
    EXPECT_NE(locked.out.find("there is no parameter to vary: --lock leaves none"), std::string::npos) << locked.out;
    const Outcome fixed = sgm("mutate " + grammar("start House -> sphere size 3\n"));
    EXPECT_EQ(fixed.code, 1);
    EXPECT_NE(fixed.out.find("there is no parameter to vary: declare one"), std::string::npos) << fixed.out;
    const Outcome none =
        sgm("mutate " + grammar("param width = 4 in 2..8.0\nstart House -> cube & cube move (width, 0, 0)\n") +
            " --resolution 24 --rows 1 --cols 1");
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.out.find("rejected"), std::string::npos) << none.out;
}

TEST_F(Cli, MutateVariesBareModels) {
    const Outcome run = sgm("mutate " + grammar("param width = 4 in 2..8.0\nstart House -> cube size (width, 3, 3)\n") +
                            " --resolution 24 --rows 1 --cols 3 --spread 1");
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(run.out.find("featureless"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("2: width="), std::string::npos) << run.out;
}

TEST_F(Cli, KeepLeavesOutWhatFloats) {
    const std::string file = grammar("start House -> cube size 4 + sphere size 2 move (0, 6, 0)\n");
    EXPECT_EQ(built(file + " --resolution 40")["mesh"]["components"], 2);
    EXPECT_EQ(built(file + " --resolution 40 --keep grounded")["mesh"]["components"], 1);
    EXPECT_EQ(built(file + " --resolution 40 --keep largest")["mesh"]["components"], 1);
    for (const char* keep : {"all", "grounded"})
        ASSERT_EQ(
            sgm("build " + file + " --resolution 40 -q --keep " + keep + " -o " + path(std::string(keep) + ".vdb"))
                .code,
            0);
    EXPECT_LT(fs::file_size(path("grounded.vdb")), fs::file_size(path("all.vdb")));
    EXPECT_EQ(sgm("build " + file + " --keep some").code, 2);
}

TEST_F(Cli, IdsAreDrawnOfWhatIsClad) {
    const std::string size = " --size 64x64 --samples 1 --view ids -o " + path("ids.png");
    EXPECT_EQ(
        sgm("render " + grammar("use \"std/kifs.sgm\"\nstart House -> Box size (12, 8, 8) clad palazzo\n") + size).code,
        0);
    EXPECT_TRUE(fs::exists(path("ids.png")));
    const Outcome bare = sgm("render " + grammar("start House -> cube\n") + size);
    EXPECT_EQ(bare.code, 1);
    EXPECT_NE(bare.out.find("nothing is clad"), std::string::npos) << bare.out;
}

}  // namespace
}  // namespace sgm::cli
