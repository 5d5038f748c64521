// `sgm check`: it tells what `sgm build` would refuse, and what other settings of the grammar would come to.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Check : public Cli {
protected:
    Outcome checked(const std::string& text, const std::string& options = "") const {
        return sgm("check " + grammar(text) + options);
    }
    /// Both refuse the grammar, and `check` says so with this place and sentence.
    void expectRefused(const std::string& text, const std::string& where, const std::string& sentence) const {
        const Outcome check = checked(text), build = sgm("build " + grammar(text) + " -q -o " + path("a.stl"));
        EXPECT_NE(build.code, 0) << text;
        EXPECT_NE(check.code, 0) << text;
        EXPECT_NE(check.out.find("test.sgm:" + where + ": error: "), std::string::npos) << check.out;
        EXPECT_NE(check.out.find(sentence), std::string::npos) << check.out;
    }
    /// It passes, with this warning.
    void expectWarned(const std::string& text, const std::string& where, const std::string& sentence) const {
        const Outcome check = checked(text);
        EXPECT_EQ(check.code, 0) << check.out;
        EXPECT_NE(check.out.find("test.sgm:" + where + ": warning: " + sentence), std::string::npos) << check.out;
    }
};

TEST_F(Check, RefusesWhatBuildRefuses) {
    expectRefused("start A -> cube : B\nrule B repeat 1000000000 -> + cube at +x : B\n", "3:29",
                  "the budget of 250000 shapes is spent");
    expectRefused("start A -> cube : B\nrule B -> for k in 1..100000000 { + cube move (k,0,0) }\n", "3:35",
                  "the budget of 250000 shapes is spent");
    expectRefused("start A -> cube & sphere move (9,0,0)\n", "2:1", "nothing solid is left of 'A'");
    expectRefused("start A -> nil\n", "2:1", "nothing solid is left of 'A'");
    expectRefused("start A -> cube size 2 - cube size 4\n", "2:1", "nothing solid is left of 'A'");
    expectRefused("start A -> cube - cube\n", "2:1", "there is no surface at cells of");
    expectRefused("start A -> cube with n = n : B\nrule B -> + cube size n at +x\n", "2:26",
                  "neither this shape nor any above it sets 'n'");
    expectRefused("start A -> size 10 split x { { 0m: cube }* }\n", "2:30", "what repeats has no extent");
    expectRefused("start A -> size 10 split x { ~0: cube | ~0: sphere }\n", "2:1", "nothing solid is left");
    expectRefused("start A -> Foo with n = 5\nrule Foo when n > 0 -> cube + Foo at +x with n = n\n", "3:29",
                  "levels of depth is spent");
}

TEST_F(Check, LooksAtTheCellsThatAreAskedFor) {
    const std::string beam = "start A -> cube size (10000, 1, 1)\n";
    expectRefused(beam, "2:1",
                  "there is no surface at cells of 78.1 m, for no part is thicker than 1 m: cells of half of");
    EXPECT_EQ(checked(beam, " --cell 5").code, 0);
    EXPECT_EQ(checked("start A -> cube size (1000, 1, 1)\n").code, 0);  // halved cells hold it
}

TEST_F(Check, BudgetsAreExitCodeThree) {
    EXPECT_EQ(checked("start A -> cube : B\nrule B repeat 1000000000 -> + cube at +x : B\n").code, 3);
}

TEST_F(Check, WarnsOfWhatFloatsAtOtherSettings) {
    const std::string rules =
        "start H -> cube size (5, 3, 5) : Body\nrule Body when kind == a -> + cube size (1, 2, 1) at +y\n"
        "rule Body -> + cube size (1, 2, 1) move (0, 6m, 0)\n";
    expectWarned("param kind = a of a, b\n" + rules, "5:14", "with kind = b: 'H/Body/cube', made by rule 'Body#2'");
    const Outcome hangs = checked("param kind = b of a, b\n" + rules);
    EXPECT_EQ(hangs.out.find("with kind"), std::string::npos)
        << "what floats anyway is told of the mesh: " << hangs.out;
}

TEST_F(Check, WarnsOfWhatOtherSettingsComeTo) {
    expectWarned("param n = 2 in 0..4\nstart A -> cube : B\nrule B -> + cube size (2m / (4 - n)) at +x\n", "4:18",
                 "with n = 4: the size of the shape isn't positive along x: (0m, 0m, 0m) in rule 'B#1' at A/B, seed 1; "
                 "divided by 0: '(4 - n)' is 0");
    expectWarned("param n = 2 in 0..4\nstart A -> cube move (2m / (4 - n), 0, 0)\n", "3:23",
                 "with n = 4: divided by 0: '(4 - n)' is 0");
    expectWarned("param deep = false\nstart A -> cube : B\nrule B when deep -> + B\n", "4:21",
                 "with deep = true: the budget of");
    expectWarned("start A -> cube\nstart B -> nil\n", "3:1", "nothing solid is left of 'B'");
    expectWarned("param n = 1 in 0..3\nstart A -> cube - cube size (n / 2 + .1)\nstyle none { n = 3 }\n", "3:1",
                 "with style 'none'");
    expectWarned("start A -> cube : B\nrule R: B -> + cube at +x\nderive d: R => R\n", "4:16",
                 "with derive 'd': rule 'R' matches nothing here");
}

TEST_F(Check, RefusesTheModelThatIsAskedFor) {
    const std::string text =
        "param n = 1 in 0..9\nstart A -> cube size (2m / (4 - n))\nstart B -> cube size (2m / (6 - n))\n"
        "style high { n = 7 }\nderive d: R0 => R0\nrule R0: C -> cube\n";
    EXPECT_EQ(checked(text, " --set n=2 --try-seconds 0").code, 0);
    for (const char* options : {" --set n=4", " --start B --style high", " --start B --set n=6"}) {
        const Outcome run = checked(text, options);
        EXPECT_EQ(run.code, 1) << options << run.out;
        EXPECT_NE(run.out.find(": error: the size of the shape isn't positive"), std::string::npos)
            << options << run.out;
    }
    EXPECT_NE(checked(text, " --derive d").out.find("error: rule 'R0' matches nothing here"), std::string::npos);
    const Outcome other = checked(text, " --start B --set n=5");
    EXPECT_EQ(other.code, 0) << other.out;
    EXPECT_NE(other.out.find(":3:17: warning: the size of the shape"), std::string::npos)
        << "what is set holds for the other starts, too: " << other.out;
}

TEST_F(Check, NamesThatTheGrammarHasNotAreWrongUsage) {
    for (const char* options : {" --start B", " --style low", " --set n=1", " --derive d"}) {
        const Outcome run = checked("start A -> cube\n", options);
        EXPECT_EQ(run.code, 2) << options << run.out;
        EXPECT_NE(run.out.find("sgm: no "), std::string::npos) << options << run.out;
    }
}

TEST_F(Check, LeavesTheLibrarysRangesAlone) {
    const Outcome check = sgm("check examples/clouds/ball.sgm");
    EXPECT_EQ(check.code, 0);
    EXPECT_EQ(check.out, "examples/clouds/ball.sgm: fine\n");
}

TEST_F(Check, SaysHowManySettingsItTried) {
    const std::string text = "param a = 1 in 1..2\nparam b = 1 in 1..2\nstart A -> cube size (a + b)\n";
    EXPECT_EQ(checked(text).out.find("note:"), std::string::npos);
    const Outcome none = checked(text, " --try-seconds 0");
    EXPECT_EQ(none.code, 0);
    EXPECT_NE(none.out.find("1 of 3 settings were tried"), std::string::npos) << none.out;
}

TEST_F(Check, CountsInExpectAreTold) {
    EXPECT_EQ(checked("start A -> cube : Tile\nrule Tile -> + Other at +x\nrule Other -> cube\ncheck A expect "
                      "count(Tile) == 1 and count(Other) == 1\n")
                  .code,
              0);
    const Outcome wrong = checked("start A -> cube : Tile\ncheck A expect count(Tile) == 5\n");
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.out.find("error: count(Tile) is 1"), std::string::npos) << wrong.out;
}

TEST_F(Check, TheSameWarningsComeFromEveryCommand) {
    const std::string file =
        grammar("start A -> cube size 4 : B\nrule B -> - cube size 1 move (9,0,0) + cone size 3 at +y\n");
    const std::string warning = "test.sgm:3:11: warning: this cuts nothing: it lies beside 'B'";
    for (const std::string& command :
         {"check " + file, "build " + file + " -o " + path("a.stl"),
          "render " + file + " --size 32x32 -o " + path("a.png"),
          "mutate " + file + " --rows 1 --cols 1 --size 32x32 -o " + path("b.png"), "tree " + file}) {
        const Outcome run = sgm(command);
        EXPECT_EQ(run.code, 0) << command << run.out;
        EXPECT_NE(run.out.find(warning), std::string::npos) << command << "\n" << run.out;
    }
}

TEST_F(Check, JsonHoldsWhatWasDerived) {
    const Outcome run = checked("start A -> nil\n", " --json");
    EXPECT_EQ(run.code, 1);
    const Json list = Json::parse(run.out);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0]["line"], 2);
    EXPECT_EQ(list[0]["severity"], "error");
}

TEST_F(Check, WhatFailsWhereItIsDerivedIsMarkedWhole) {
    const Outcome run = checked("start A -> cube : B\nrule B -> cube with k = 2 : C\nrule C -> + cube size (2 - k)\n");
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.out.find("\n  rule C -> + cube size (2 - k)\n                   ^~~~~~~~~~~~\n"), std::string::npos)
        << run.out;
}

TEST_F(Check, ATextThatIsNoUtf8IsTold) {
    expectWarned("param n = 2 in 0..4 \"Zahl der T\xfcren\"\nstart A -> cube size (n + 1)\n", "2:21",
                 "this text is no UTF-8");
    EXPECT_EQ(
        checked("param n = 2 in 0..4 \"Zahl der T\xc3\xbcren\"\nstart A -> cube size (n + 1)\n").out.find("warning"),
        std::string::npos);
}

TEST_F(Check, AUsedFileThatIsMissingNamesTheNearestOne) {
    const Outcome run = checked("use \"std/wals.sgm\"\nstart A -> cube\n");
    EXPECT_NE(run.out.find("can't use \"std/wals.sgm\": there is no such file; did you mean \"std/walls.sgm\"?"),
              std::string::npos)
        << run.out;
    EXPECT_NE(checked("use \"std/zzzzzz.sgm\"\nstart A -> cube\n").out.find("there is no such file\n"),
              std::string::npos);
}

TEST_F(Check, ANameOfTheLibraryNamesItsFile) {
    EXPECT_NE(checked("start A -> cube size 4 clad palazzo\n").out.find("write 'use \"std/kifs.sgm\"'"),
              std::string::npos);
    EXPECT_NE(checked("start A -> stone\n").out.find("write 'use \"std/walls.sgm\"'"), std::string::npos);
    EXPECT_NE(checked("start A -> Storey\n").out.find("write 'rule Storey -> …', or 'use \"std/house.sgm\"'"),
              std::string::npos);
    EXPECT_EQ(checked("start A -> spere\n").out.find("use"), std::string::npos);
}

TEST_F(Check, AnObjectThatHangsInTheAirIsAWarning) {
    const Outcome run = checked(
        "start Town -> cube size (20, 1, 20) + Lot size 8 at +y move (0, 6, 0)\n"
        "rule Lot -> place House\n"
        "start House -> cube size 4\n");
    EXPECT_EQ(run.code, 0);
    EXPECT_NE(run.out.find("floats: the object 'House' touches nothing that stands; 6 m below is 'Town/cube'"),
              std::string::npos)
        << run.out;
}

TEST(Usage, NamesTheCommandThatWasMeant) {
    const Outcome run = sgm("biuld x.sgm");
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.out.find("no command 'biuld'; did you mean 'build'?"), std::string::npos) << run.out;
    EXPECT_NE(sgm("--max-memory 1GB biuld x.sgm").out.find("did you mean 'build'?"), std::string::npos);
    EXPECT_NE(sgm("paint x.sgm").out.find("no command 'paint': there are build, render"), std::string::npos);
}

TEST(Usage, NamesTheCommandThatHasAnOption) {
    const Outcome run = sgm("render examples/morphs.sgm -o a.png --animate twist=0..6:4");
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.out.find("'sgm render' has no option --animate: it belongs to 'sgm build'"), std::string::npos)
        << run.out;
    EXPECT_NE(sgm("build examples/morphs.sgm --resolutoin 4")
                  .out.find("'sgm build' has no option --resolutoin; did you mean --resolution?"),
              std::string::npos);
    EXPECT_NE(sgm("build").out.find("FILE is required"), std::string::npos) << "other mistakes as before";
}

}  // namespace
}  // namespace sgm::cli
