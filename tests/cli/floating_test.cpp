// What hangs in the air is reported with its rule and line.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

TEST_F(Cli, AFloatingStoreyIsReportedWithItsRuleAndLine) {
    const std::string file = grammar(
        "start House -> cube size (8, 3, 6) : Storey\n"
        "rule Build: Storey repeat 3\n"
        "  -> + cube size (8, 3, 6) at +y move (0, if(i == 2, 1, 0), 0) : Storey\n");
    const Outcome run = sgm("build " + file + " --resolution 32 --report " + path("r.json"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("'House/Storey/Storey[2]', made by rule 'Build' (" + file + ":4) floats"), std::string::npos) << run.out;
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["pieces"], 2);
    ASSERT_EQ(report["floating"].size(), 1u);
    EXPECT_EQ(report["floating"][0]["rule"], "Build");
    EXPECT_EQ(report["floating"][0]["line"], 4);
    EXPECT_NEAR(report["floating"][0]["volume_m3"].get<double>(), 2 * 8 * 3 * 6, 3);
}

TEST_F(Cli, AStalactiteThatHangsInTheAirIsReported) {
    const std::string cave = "start Cave -> cube size 20 - sphere size 16 + Drip size (1, 4, 1) move (0, ";
    const std::string file = grammar(cave + "3, 0)\nrule Drip -> cone turn (180deg, 0deg, 0deg)\n");
    const Outcome run = sgm("build " + file + " --resolution 64");
    EXPECT_NE(run.out.find("'Cave/cube/Drip', made by the start (" + file + ":2) floats"), std::string::npos) << run.out;
    const Outcome hangs = sgm("build " + grammar(cave + "6.5, 0)\nrule Drip -> cone turn (180deg, 0deg, 0deg)\n") + " --resolution 64");
    EXPECT_EQ(hangs.out.find("floats"), std::string::npos) << hangs.out;
}

TEST_F(Cli, AFloatingStalactiteIsReported) {
    const std::string hanging = "start Rock -> cube size (8, 6, 8) - cube size (6, 4, 6) + cone size (1, 2, 1) turn (180deg, 0deg, 0deg) move (0, ";
    const Outcome floats = sgm("build " + grammar(hanging + ".5, 0)\n") + " --cell .1");
    EXPECT_EQ(floats.code, 0);
    EXPECT_NE(floats.out.find("floats"), std::string::npos) << floats.out;
    const Outcome attached = sgm("build " + grammar(hanging + "1.1, 0)\n") + " --cell .1");
    EXPECT_EQ(attached.out.find("floats"), std::string::npos) << attached.out;
}

}  // namespace
}  // namespace sgm::cli
