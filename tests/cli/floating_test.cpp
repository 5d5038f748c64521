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
    EXPECT_NE(run.out.find("'House/Storey/Storey[2]', made by rule 'Build' (" + file + ":4) floats"), std::string::npos)
        << run.out;
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
    EXPECT_NE(run.out.find("'Cave/cube/Drip', made by the start (" + file + ":2) floats"), std::string::npos)
        << run.out;
    const Outcome hangs =
        sgm("build " + grammar(cave + "6.5, 0)\nrule Drip -> cone turn (180deg, 0deg, 0deg)\n") + " --resolution 64");
    EXPECT_EQ(hangs.out.find("floats"), std::string::npos) << hangs.out;
}

TEST_F(Cli, AFloatingStalactiteIsReported) {
    const std::string hanging =
        "start Rock -> cube size (8, 6, 8) - cube size (6, 4, 6) + cone size (1, 2, 1) turn (180deg, 0deg, 0deg) move "
        "(0, ";
    const Outcome floats = sgm("build " + grammar(hanging + ".5, 0)\n") + " --cell .1");
    EXPECT_EQ(floats.code, 0);
    EXPECT_NE(floats.out.find("floats"), std::string::npos) << floats.out;
    const Outcome attached = sgm("build " + grammar(hanging + "1.1, 0)\n") + " --cell .1");
    EXPECT_EQ(attached.out.find("floats"), std::string::npos) << attached.out;
}

TEST_F(Cli, AGapIsMeasuredBetweenTheNearestParts) {
    const std::string file = grammar(
        "start House -> cube size (8, 3, 6) : Storey\n"
        "rule Build: Storey repeat 3\n"
        "  -> + cube size (8, 3, 6) at +y move (0, if(i == 2, 1, 0), 0) : Storey\n");
    const Outcome run = sgm("build " + file + " --resolution 32 --report " + path("r.json"));
    EXPECT_NE(run.out.find("a gap of 1 m lies between its 'House/Storey/Storey[2]' (" + file +
                           ":4) and 'House/Storey/Storey' (" + file + ":4) at ("),
              std::string::npos)
        << run.out;
    const Json cause = Json::parse(read(path("r.json")))["floating"][0]["cause"];
    EXPECT_EQ(cause["kind"], "gap");
    EXPECT_NEAR(cause["width_m"].get<double>(), 1, 1e-4);
    EXPECT_NEAR(cause["at"][1].get<double>(), 5, 1e-4);
}

TEST_F(Cli, AGapBetweenAPostAndAPlateIsMeasuredAtThePost) {
    const std::string file = grammar(
        "start A -> cube size (20, .5, 20), cylinder size (.6, 3, .6) move (3.3, 1.75, 2.1), cube size (20, .5, 20) "
        "move (0, 3.95, 0)\n");
    const Outcome run = sgm("build " + file + " --cell .25 --report " + path("r.json"));
    const Json floating = Json::parse(read(path("r.json")))["floating"];
    ASSERT_EQ(floating.size(), 1u) << run.out;
    EXPECT_NEAR(floating[0]["cause"]["width_m"].get<double>(), .45, .001);
    EXPECT_NEAR(floating[0]["cause"]["at"][0].get<double>(), 3.3, .31);
    EXPECT_EQ(floating[0]["cause"]["to"]["path"], "A/cylinder");
}

TEST_F(Cli, AFloatingPieceNamesTheThinPartThatHoldsIt) {
    const std::string file = grammar(
        "start A -> cube size (20, .5, 20) : Base\n"
        "rule Base -> + cube size (.12, 3, .12) at +y move (.13, 0, .13) : Post\n"
        "rule Post -> + sphere size .9 at +y overlap .3\n");
    const Outcome coarse = sgm("build " + file + " --cell .29 --halvings 0 --report " + path("r.json"));
    EXPECT_NE(coarse.out.find("'A/Base/Post' (" + file +
                              ":3), 0.12 m thick, holds it and is thinner than a cell of 0.29 m: --resolution "),
              std::string::npos)
        << coarse.out;
    const Json cause = Json::parse(read(path("r.json")))["floating"][0]["cause"];
    EXPECT_EQ(cause["kind"], "thin");
    EXPECT_EQ(cause["part"]["line"], 3);
    const Outcome fine = sgm("build " + file + " --cell " + std::to_string(cause["cell_m"].get<double>()));
    EXPECT_EQ(fine.out.find("floats"), std::string::npos) << fine.out;
}

TEST_F(Cli, AFragmentOfAThinWallIsNoPieceOverAGap) {
    const std::string file = grammar(
        "start A -> size (34, 5, 3) cube + Tube size (34, 8, 26) at +y\n"
        "rule Tube -> cylinder - cylinder size (100% - .04m, 120%, 100% - .04m)\n");
    const Outcome run = sgm("build " + file + " --resolution 64");
    EXPECT_NE(run.out.find("m of 'A/cube/Tube/cylinder/cylinder' (" + file + ":3), which is thinner than a cell"),
              std::string::npos)
        << run.out;
    EXPECT_EQ(run.out.find("a gap of"), std::string::npos) << run.out;
}

TEST_F(Cli, CheckTellsAGapAlsoWhereSomethingElseIsTooThin) {
    const char* const parts[] = {"cube size (20, .5, 20) + cube size (.4, 3, .4) at +y move (.13, .4, .13)",
                                 ", cube size (.01, 3, .01) move (7.03, 1.75, 6.03)"};
    const Outcome both = sgm("check " + grammar("start A -> " + std::string(parts[0]) + parts[1] + "\n"));
    EXPECT_NE(both.out.find("a gap of 0.4 m"), std::string::npos) << both.out;
    EXPECT_NE(both.out.find("no errors, 1 warning"), std::string::npos) << both.out;
}

TEST_F(Cli, PartsThatMeetByLessThanACellAreToldFromAGap) {
    const auto built = [&](const char* place, const char* cell) {
        return sgm("build " + grammar(std::string("start A -> sphere size 5, sphere size 4 move ") + place + "\n") +
                   " --cell " + cell)
            .out;
    };
    EXPECT_NE(built("(3.15, 3.182, .15)", ".9").find("by less than a cell of 0.9 m: let them overlap more"),
              std::string::npos);
    EXPECT_NE(built("(3.2, 3.146, .15)", ".85").find("by less than a cell of 0.85 m: let them overlap more"),
              std::string::npos);
    EXPECT_NE(built("(.3, 4.8, .05)", ".4").find("a gap of 0.3"), std::string::npos);
}

TEST_F(Cli, EveryCommandTellsGapsAndThinParts) {
    const std::string gap = grammar(
        "start A -> cube size (20, .5, 20) : Base\n"
        "rule Base -> + cube size (.4, 3, .4) at +y move (.13, .4, .13)\n");
    const std::string thin = scratch_
                                 .write("thin.sgm",
                                        "grammar 1\nstart A -> cube size (20, 3, 20) : Base\n"
                                        "rule Base -> + cube size (.015, 3, .015) at +y move (.13, 0, .13) "
                                        "turn (0deg, 20deg, 0deg)\n")
                                 .string();
    const std::string picture = " --size 32x32 -o " + path("a.png");
    for (const std::string command : {"check ", "build ", "mutate ", "render "}) {
        const std::string more = command == "render " ? picture : command == "mutate " ? " --rows 1 --cols 1" : "";
        const Outcome floats = sgm(command + gap + more), lost = sgm(command + thin + more);
        if (floats.out.find("EGL") != std::string::npos) continue;  // nothing can be drawn here
        EXPECT_NE(floats.out.find("a gap of 0.4 m lies between its 'A/Base/cube' (" + gap + ":3) and 'A/Base' (" + gap +
                                  ":2)"),
                  std::string::npos)
            << command << floats.out;
        EXPECT_NE(lost.out.find("a 'cube' of 0.015 m is too thin for the mesh's cells of"), std::string::npos)
            << command << lost.out;
        EXPECT_NE(lost.out.find(thin + ":3:"), std::string::npos) << command << lost.out;
    }
}

TEST_F(Cli, TheLargestFloatingPieceIsToldFirst) {
    const std::string file = grammar(
        "start A -> cube size (20, 1, 20) for k in 0..9 { + cube size .8 move (2 * k - 9, 4, 0) } + cube size 3 move "
        "(0, 9, 0)\n");
    const Outcome run = sgm("build " + file + " --resolution 64 --report " + path("r.json"));
    const Json floating = Json::parse(read(path("r.json")))["floating"];
    ASSERT_EQ(floating.size(), 11u) << run.out;
    EXPECT_NEAR(floating[0]["volume_m3"].get<double>(), 27, .1);
    EXPECT_NE(run.out.find("27 m³ about (0.00, 9.00, 0.00)"), std::string::npos) << run.out;
}

TEST_F(Cli, AThinPartElsewhereOnTheShapeOfAFloatingPieceDoesNotHoldIt) {
    const std::string file = grammar(
        "start A -> (cube size (40, 4, 4) - cube size (2, 5, 5) move (5m, 0, 0) + cube size (4, 12, 4) move (-18m, 0, "
        "0)) "
        "+ cylinder size .05m from (-18m, 1m, -8m) to (-18m, 1m, 8m)\n");
    const Outcome run = sgm("build " + file + " --resolution 128");
    EXPECT_NE(run.out.find("a gap of 2 m divides"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("thick, holds it"), std::string::npos) << run.out;
}

TEST_F(Cli, AShellAroundAFloatingPieceDoesNotHoldIt) {
    const std::filesystem::path file = scratch_.write(
        "room.sgm",
        "grammar 2\nstart S -> size (18, 3, 14) Room\n"
        "rule Room -> cube size (20, .1, 16) move (0, -50% - .05m, 0) + cube size (2, 1, 2) + shellBlock(.1m, 0m) "
        "footprint round(64)\n");
    const Outcome run = sgm("check " + file.string());
    EXPECT_NE(run.out.find("a gap of 1 m lies between"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("thick, holds it"), std::string::npos) << run.out;
}

TEST_F(Cli, PartsThatTheCellsOfAnObjectLackAreTold) {
    const std::string file = grammar(
        "start Town -> cube size (40, 4, 40) : G\n"
        "rule G -> + place House at +y\n"
        "start House -> cube size (20, 6, 20) + cube size (.05m, 3m, .05m) at +x\n");
    const std::string lacks = "lacks 100 % of the surface: --object-cell ";
    const Outcome built = sgm("build " + file + " --halvings 0 -o " + path("a.glb"));
    EXPECT_EQ(built.code, 0);
    EXPECT_NE(built.out.find(":4: a 'cube' of 0.05 m is too thin for the cells of 'House' of 0.157 m and " + lacks),
              std::string::npos)
        << built.out;
    const size_t at = built.out.find(lacks) + lacks.size();
    const std::string cell = built.out.substr(at, built.out.find(' ', at) - at);
    const Outcome finer = sgm("build " + file + " --halvings 0 --object-cell " + cell + " -o " + path("a.glb"));
    EXPECT_EQ(finer.out.find("too thin"), std::string::npos) << cell << finer.out;
    EXPECT_EQ(sgm("build " + file + " -o " + path("a.glb")).out.find("too thin"), std::string::npos);
    EXPECT_EQ(sgm("build " + file + " -q -o " + path("a.glb")).out, "");
    const Outcome drawn = sgm("render " + file + " --size 32x32 --halvings 0 -o " + path("a.png"));
    if (drawn.out.find("EGL") != std::string::npos) return;  // nothing can be drawn here
    EXPECT_NE(drawn.out.find("too thin for the cells of 'House'"), std::string::npos) << drawn.out;
    EXPECT_EQ(drawn.out.find("--resolution"), std::string::npos) << drawn.out;
}

TEST_F(Cli, WhatFloatsWithinAnObjectIsTold) {
    const std::string file = grammar(
        "start Town -> cube size (40, 4, 40) : G\n"
        "rule G -> + place House at +y\n"
        "start House -> cube size (20, 6, 20) + cube size 4 at +y move (0, 1.5m, 0)\n");
    const std::string out = sgm("build " + file + " -o " + path("a.glb")).out;
    EXPECT_NE(out.find("'House/cube/cube', made by the start (" + file + ":4) floats: 64 m³"), std::string::npos)
        << out;
    EXPECT_NE(out.find("a gap of 1.5 m lies between"), std::string::npos) << out;
}

TEST_F(Cli, PicturesWarnAtTheCellsThatAreAskedFor) {
    const std::string file = grammar(
        "start A -> cube size (20, 1, 1) + cube size (.05, 2, .05) move (.05, 1, .03)"
        " + cube size (.05, 2, .05) move (3.05, 1, .13)\n");
    const auto drawn = [&](const std::string& cells) {
        return sgm("render " + file + " --size 32x32 --halvings 0 " + cells + " -o " + path("a.png")).out;
    };
    if (drawn("").find("EGL") != std::string::npos) GTEST_SKIP() << "nothing can be drawn here";
    EXPECT_NE(drawn("").find("the mesh's cells of 0.156 m"), std::string::npos);
    EXPECT_EQ(drawn("--resolution 420").find("too thin"), std::string::npos);
    EXPECT_NE(drawn("--resolution 64").find("the mesh's cells of 0.313 m"), std::string::npos);
    EXPECT_EQ(drawn("--cell .04").find("too thin"), std::string::npos);
}

}  // namespace
}  // namespace sgm::cli
