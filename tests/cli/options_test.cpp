// What options take, and what is said of what they don't.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

const char* const ball = "build examples/clouds/ball.sgm ";

TEST_F(Cli, OptionsSayWhatTheyTake) {
    const auto refused = [&](const std::string& arguments, const std::string& said) {
        const Outcome run = sgm(ball + arguments);
        EXPECT_EQ(run.code, 2) << arguments;
        EXPECT_NE(run.out.find(said), std::string::npos) << arguments << ": " << run.out;
        EXPECT_EQ(run.out.find("FAILED"), std::string::npos) << run.out;
    };
    refused("--seed -1", "'-1' is no whole number from 0 to 18446744073709551615");
    refused("--seed 1.5", "'1.5' is no whole number");
    refused("--resolution 1.5", "'1.5' is no whole number from 2 to 8192");
    refused("--resolution 1", "'1' is no whole number from 2 to 8192");
    refused("--keep ground", "'ground' is none of all, grounded, largest; did you mean 'grounded'?");
    refused("--surface Crips", "'Crips' is none of crisp, cubes; did you mean 'crisp'?");
    refused("--threads -2", "'-2' is no whole number from 0 to 1024");
    refused("--start B", "no start is called 'B'; there are ");
    refused("--style Tall", "no style is called 'Tall'; there are default");
    EXPECT_EQ(
        sgm(ball + std::string("-q --resolution 16 --keep grounded --surface cubes --seed 18446744073709551615 -o ") +
            path("a.obj"))
            .code,
        0);
}

TEST_F(Cli, NamesThatExistAreListed) {
    const std::string file = grammar(
        "param high = 1 in 1..9\nstart House -> cube\nstart Tower -> cube size (1, high, 1)\n"
        "style Low for Tower { high = 1 }\nstyle Tall for Tower { high = 9 }\n");
    EXPECT_NE(sgm("build " + file + " --start Towr")
                  .out.find("no start is called 'Towr' (did you mean 'Tower'?); there are House, Tower"),
              std::string::npos);
    EXPECT_NE(sgm("build " + file + " --style X").out.find("no style is called 'X'; there are Low, Tall"),
              std::string::npos);
}

TEST_F(Cli, PicturesTellAnEyeInRockAndASectionThatCutsNothing) {
    const std::string file = grammar("start A -> cube size 8 - sphere size 6\n");
    const std::string draw = "render " + file + " --size 16x16 -o " + path("a.png");
    const Outcome same = sgm(draw + " --camera 1,1,1,1,1,1");
    EXPECT_EQ(same.code, 2);
    EXPECT_NE(same.out.find("the eye stands where it looks"), std::string::npos) << same.out;
    const Outcome early = sgm("render nowhere.sgm -o " + path("a.png") + " --camera 1,2");
    EXPECT_NE(early.out.find("--camera 1,2: write EYE,AT"), std::string::npos)
        << "before the file is read: " << early.out;
    const Outcome within = sgm(draw + " --camera 3.5,0,0,0,0,0");
    if (within.out.find("EGL") != std::string::npos) GTEST_SKIP() << "nothing can be drawn here";
    EXPECT_NE(within.out.find("warning: the eye stands at least 0.5 m within the solid at (3.5, 0, 0)"),
              std::string::npos)
        << within.out;
    EXPECT_EQ(sgm(draw + " --camera 0,0,0,3,0,0").out.find("warning"), std::string::npos);
    EXPECT_NE(sgm(draw + " --section x=500")
                  .out.find("warning: --section x=500 cuts nothing: the model reaches from -4 to 4 m"),
              std::string::npos);
    EXPECT_NE(sgm(draw + " --section x=150%").out.find("warning: --section x=150% cuts nothing"), std::string::npos);
    for (const char* at : {"x=1", "x=10cm", "x=50%"})
        EXPECT_EQ(sgm(draw + " --section " + at).out.find("warning"), std::string::npos) << at;
    const Outcome solid =
        sgm("render " + grammar("start A -> cube size 8\n") + " --size 16x16 --camera inside -o " + path("a.png"));
    const Outcome fog = sgm("render " + grammar("start A -> sphere size 8\n") +
                            " --view fog --resolution 16 --size 16x16 --camera inside -o " + path("a.png"));
    EXPECT_NE(fog.out.find("within the fog, where there is little else to be seen"), std::string::npos) << fog.out;
    EXPECT_NE(solid.out.find("the model has no hollow to stand in: leave --camera inside out"), std::string::npos)
        << solid.out;
}

TEST_F(Cli, AMeshSeenFromAHollowIsLitByALamp) {
    const std::string file = grammar("start A -> cube size 8 - sphere size 6\n");
    const auto drawn = [&](const std::string& options) {
        const Outcome run = sgm("render " + file + " --size 32x32 --view mesh --resolution 32 -o " + path("a.png") +
                                " --camera " + options);
        return run.code == 0 ? read(path("a.png")) : "";
    };
    const std::string lit = drawn("0,0,0,3,0,0");
    if (lit.empty()) GTEST_SKIP() << "nothing can be drawn here";
    EXPECT_NE(lit, drawn("0,0,0,3,0,0 --lamp 0"));
    EXPECT_EQ(drawn("20,0,0,3,0,0"), drawn("20,0,0,3,0,0 --lamp 0"));
    EXPECT_EQ(sgm("render " + file + " --lamp -1 -o " + path("a.png")).code, 2);
}

TEST_F(Cli, OptionsThatWouldDoNothingAreRefused) {
    const std::string file = grammar("start A -> cube size 8\n"), vdb = path("a.vdb"), picture = path("a_%d.png");
    const std::string build = "build -q --cell 40cm " + file + " -o " + vdb + " --format-option ";
    for (const auto& [options, words] :
         {std::pair("density=7", "option 'density' of .vdb is about fog, and the file holds none: add grids=fog"),
          std::pair("distance=raw --format-option grids=fog", "'distance' of .vdb is about levelset")}) {
        const Outcome run = sgm(build + options);
        EXPECT_EQ(run.code, 2) << options;
        EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
        EXPECT_FALSE(fs::exists(vdb));
    }
    const Outcome numbered = sgm("render " + file + " -o " + picture);
    EXPECT_EQ(numbered.code, 2);
    EXPECT_NE(numbered.out.find("the name numbers pictures: add --turntable COUNT"), std::string::npos) << numbered.out;
    EXPECT_FALSE(fs::exists(picture));
}

TEST_F(Cli, QuietSaysNothingButErrors) {
    const std::string file = grammar("param lush = 1 in 0..9\nstart A -> cube\nrule B -> cube\n");
    for (const std::string& command :
         {"build " + file + " -o " + path("a.obj"), "render " + file + " --size 16x16 -o " + path("a.png")}) {
        const Outcome run = sgm(command);
        if (run.out.find("EGL") != std::string::npos) continue;
        EXPECT_NE(run.out.find("nothing uses the parameter 'lush'"), std::string::npos) << run.out;
        EXPECT_EQ(sgm(command + " -q").out, "");
    }
}

TEST_F(Cli, CheckCountsItsWarnings) {
    const std::string file = grammar("param lush = 1 in 0..9\nstart A -> cube\nrule B -> cube\n");
    EXPECT_NE(sgm("check " + file).out.find(file + ": no errors, 2 warnings\n"), std::string::npos);
}

TEST_F(Cli, ParamsShowRealRangesAsTheyAreWritten) {
    const std::string file =
        grammar("param wet = .5 in 0..1.0\nparam n = 1 in 0..2\nstart A -> cube size (1, wet + 1, n + 1)\n");
    const std::string listed = sgm("params " + file).out;
    EXPECT_NE(listed.find("in 0..1.0"), std::string::npos) << listed;
    EXPECT_NE(listed.find("in 0..2 "), std::string::npos) << listed;
}

}  // namespace
}  // namespace sgm::cli
