// Rules that never run and rules that never end.
#include <gtest/gtest.h>

#include "tests/cpu_time.h"
#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

/// What is said of the rules behind `start S -> cube : A`.
std::string judged(const std::string& rules) { return checkedBody("start S -> cube : A\n" + rules).messages(); }

TEST(Endless, RulesAreNamed) {
    EXPECT_EQ(judged("rule Grow: A -> + cube at +x : A\n"), "rule 'Grow' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> cube : A\n"), "rule 'A#1' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> (sphere + A at +y)\n"), "rule 'A#1' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> cube for d in axes { + A }\n"), "rule 'A#1' never ends: every 'A' makes another 'A'\n");
}

TEST(Endless, SharesOfASplitAreNamed) {
    const std::string never = "rule 'A#1' never ends: every 'A' makes another 'A'\n";
    EXPECT_EQ(judged("rule A -> split x { 50%: A | ~1: cube }\n"), never);
    EXPECT_EQ(judged("rule A -> split x { ~1: cube | ~2: A }\n"), never);
    EXPECT_EQ(judged("rule A -> split x { 20%: cube | 120%: A }\n"), never) << "cut off at 80 %";
    EXPECT_EQ(judged("rule A -> split x { 50%: B | ~1: cube }\nrule B -> split y { ~1: A | ~1: cube }\n"),
              "rule 'A#1' never ends: 'A' (A#1) -> 'B' (B#1) -> 'A'\n");
    EXPECT_EQ(judged("rule A -> split x { 3m: cube | ~1: A }\n"), "") << "3 m are left at last, or less";
    EXPECT_EQ(judged("rule A -> split x { 50%: A | 1m: cube | ~1: cube }\n"), "") << "lengths are left alone";
    EXPECT_EQ(judged("rule A -> split x { 100%: cube | 50%: A }\n"), "") << "no room for it";
    EXPECT_EQ(judged("rule A -> split x { 0%: A | ~1: cube }\n"), "");
    EXPECT_EQ(judged("rule A -> split x { { ~2m: cube }* | 3m: A }\n"), "");
    EXPECT_EQ(judged("rule A when scope.x > 1 -> split x { 50%: A | ~1: cube }\n"), "");
    EXPECT_EQ(judged("rule A -> split x { 50%: choose { 1: A | 1: cube } | ~1: cube }\n"), "");
    EXPECT_EQ(judged("rule A -> split x { 50%: A | ~1: cube }\nrule A -> cube\n"), "") << "drawn by weight";
}

TEST(Siblings, WithoutAShapeAreTold) {
    const std::string told = "warning: this adds nothing: it names no shape\n";
    EXPECT_EQ(judged("rule A -> cube, size 1m\n"), told);
    EXPECT_EQ(judged("rule A -> size 1m\n"), told);
    EXPECT_EQ(judged("rule A -> + (move (0, 1m, 0)) at +y\n"), told);
    EXPECT_EQ(judged("rule A -> let w = 1m..2m size w\n"), told);
    EXPECT_EQ(judged("rule A -> split x { ~1: footprint rect(2, 2) extrude 1m | ~1: cube }\n"), told);
    EXPECT_EQ(judged("rule A -> cube, size 1m report gfa (scope.area)\n"), "") << "a sum is what it is for";
    EXPECT_EQ(judged("rule A -> size 4m + cube at +y\n").find("adds nothing"), std::string::npos)
        << "cubes stand on it";
    EXPECT_EQ(judged("rule A -> nil, size 1m row 3 along x { cube }\n"), "");
}

TEST(Plans, ThatASolidTakesNoNoticeOfAreTold) {
    const std::string told = "fills its scope, whatever plan it has: this does nothing but set its size\n";
    const std::string ofCube = "warning: 'cube' " + told;
    EXPECT_EQ(judged("rule A -> footprint ell(16, 12, 5, 6) extrude 3m cube\n"), ofCube);
    EXPECT_EQ(judged("rule A -> cube size 4m footprint ngon(6) offset .1m\n"), ofCube) << "once a shape";
    EXPECT_EQ(judged("rule A -> size 20m court 4m (cube)\n"), "") << "what is in the group may stand over it";
    EXPECT_EQ(judged("rule A -> size 20m court 4m cube of clay\nmaterial clay color #884422\n"), ofCube);
    EXPECT_EQ(judged("terminal w = sphere\nrule A -> footprint ngon(6) extrude 3m w\n"), "warning: 'w' " + told);
    EXPECT_EQ(judged("rule A -> footprint ell(16, 12, 5, 6) extrude 3m block\n"), "");
    EXPECT_EQ(judged("rule A -> footprint ell(16, 12, 5, 6) hipRoof\n"), "");
    EXPECT_EQ(judged("terminal w color #ffffff\nrule A -> footprint ngon(6) extrude 3m w\n"), "");
    EXPECT_EQ(judged("rule A -> footprint rect(4, 3) extrude 3m cube\n"), "") << "it is that box";
    EXPECT_EQ(judged("rule A -> footprint ell(16, 12, 5, 6) inner cube\n"), "");
}

TEST(Roofs, OverTheScopeInPlaceOfTheShapeBeforeThemAreTold) {
    const auto told = [](const std::string& rule) {
        return checked("grammar 2\nstart S -> cube size (20, 4, 20) : A\nrule A -> " + rule + "\n").messages();
    };
    const std::string ofBlock =
        "warning: 'hipRoof' stands over the whole scope of 'A', not over the 'block' before it\n";
    EXPECT_EQ(told("footprint ell(11, 10, 4, 4) block + hipRoof(40deg) at +y"), ofBlock);
    EXPECT_EQ(told("setback 2m block + hipRoof at +y"), ofBlock);
    EXPECT_EQ(told("size (50%, 100%, 100%) block + hipRoof at +y"), ofBlock);
    EXPECT_EQ(told("size (100%, 3m, 100%) block + hipRoof at +y"), "");
    EXPECT_EQ(told("footprint ell(11, 10, 4, 4) block + footprint ell(11, 10, 4, 4) hipRoof at +y"), "");
    EXPECT_EQ(told("block + hipRoof at +y"), "");
    EXPECT_EQ(told("size (8, 3, 8) cube + cube size 1 at +y"), "");
}

TEST(Sizes, ThatUndoWhatStandsBeforeThemAreTold) {
    EXPECT_EQ(judged("rule A -> footprint rect(10, 10) extrude 3m size (4, 4, 4) block\n"),
              "warning: this size undoes 'extrude' before it\n");
    EXPECT_EQ(judged("rule A -> offset 1m size (4m, 100%, 4m) block\n"),
              "warning: this size undoes 'offset' before it\n");
    EXPECT_EQ(judged("rule A -> extrude 3m size (50%, 100%, 50%) block\n"), "");
    EXPECT_EQ(judged("rule A -> size (4, 4, 4) extrude 3m block\n"), "");
    EXPECT_EQ(judged("rule A -> extrude 3m cube size (1, 1, 1)\n"), "") << "that of what stands in the scope";
}

TEST(Weights, OfRulesThatConditionsChooseAreTold) {
    EXPECT_EQ(judged("rule A weight 3 when scope.x > 1m -> cube\nrule A -> sphere\n"),
              "warning: this weight does nothing: of rules with 'when' the first one that holds wins\n");
    EXPECT_EQ(judged("rule A weight 3 -> cube\nrule A weight 1 -> sphere\n"), "");
}

TEST(Repeats, WhoseStepsReplaceOneAnotherAreTold) {
    EXPECT_EQ(judged("rule A repeat 3 -> cube size (i, 1, 1) : A\n"),
              "warning: each step replaces what the one before made, so that the last 'cube' alone is left\n");
    EXPECT_EQ(judged("rule A repeat 3 -> + cube at +x : A\n"), "");
    EXPECT_EQ(judged("rule A repeat 3 -> cube + sphere at +y : A\n"), "");
    EXPECT_EQ(judged("rule A repeat 3 -> split x { ~1: cube : A | ~1: cube }\n"), "");
}

TEST(WaitingCycles, AreToldOnce) {
    EXPECT_EQ(judged("rule A -> cube : B, cube : C\nrule B after C -> cube\nrule C after B -> cube\n"),
              "warning: 'B' waits for 'C', and 'C' waits for 'B': nothing decides which comes first\n");
    EXPECT_EQ(judged("rule A -> cube : B, cube : C\nrule B after C -> cube\nrule C -> cube\n"), "");
    EXPECT_EQ(
        judged("rule A -> cube : B, cube : C, cube : D\nrule B after C -> cube\nrule C after D -> cube\n"
               "rule D after B -> cube\nrule D after C -> cube\n"),
        "warning: 'B' waits for 'C', and 'C' waits for 'D', and 'D' waits for 'B': nothing decides which comes first\n"
        "warning: 'C' waits for 'D', and 'D' waits for 'C': nothing decides which comes first\n");
}

TEST(Endless, CirclesAreNamed) {
    EXPECT_EQ(judged("rule A -> B\nrule B -> C, cube\nrule C -> sphere : A\n"),
              "rule 'A#1' never ends: 'A' (A#1) -> 'B' (B#1) -> 'C' (C#1) -> 'A'\n");
    EXPECT_EQ(judged("rule A -> B\nrule B -> B\n"), "rule 'B#1' never ends: every 'B' makes another 'B'\n");
}

TEST(Endless, EveryAlternativeMustGoOn) {
    EXPECT_EQ(judged("rule A -> choose { 1: cube : A | 2: sphere : A }\n"),
              "rule 'A#1' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> choose { 1: cube : A | 2: sphere }\n"), "");
    EXPECT_EQ(judged("rule A -> choose { 1: cube : A | 0: sphere }\n"),
              "rule 'A#1' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> cube : A\nrule A -> sphere\n"), "") << "drawn by weight";
    EXPECT_EQ(judged("rule A -> cube : A\nrule A weight 0 -> sphere\n"),
              "rule 'A#1' never ends: every 'A' makes another 'A'\n");
}

TEST(Endless, WhatMayStopIsAllowed) {
    EXPECT_EQ(judged("rule A repeat 9 -> + cube at +x : A\n"), "");
    EXPECT_EQ(judged("rule A when scope.x > 1 -> cube size 50% : A\n"), "");
    EXPECT_EQ(judged("rule A -> + cube at free() : A\n"), "") << "joints run out";
    EXPECT_EQ(judged("rule A beside A -> + cube at +x : A\n"), "");
    EXPECT_EQ(judged("rule A -> cube when scope.x > 1 { + cube at +x : A }\n"), "");
    EXPECT_EQ(judged("rule A -> cube for k in 1..0 { + A }\n"), "") << "no turn at all";
    EXPECT_EQ(judged("rule A -> + cube at +x : B\nrule B -> + cube at +y : A\n"), "") << "may meet itself";
    EXPECT_EQ(judged("rule A -> + cube at +x to +x : A\n"), "") << "the next joint is taken";
    EXPECT_EQ(judged("rule A -> + cube at +x : Done\n"), "");
}

TEST(Endless, AGuardThatAlwaysHoldsIsNone) {
    EXPECT_EQ(judged("rule A when 1 < 2 -> cube : A\n"), "rule 'A#1' never ends: every 'A' makes another 'A'\n");
    EXPECT_EQ(judged("rule A -> cube while true { + cube at +x }\n"),
              "this 'while' never ends: its condition always holds\n");
}

/// A chain of rules down to one that ends, or back to its first; either way round in the text.
std::string chain(int length, bool ends, bool backwards) {
    std::string rules;
    for (int i = 0; i < length; ++i) {
        const int at = backwards ? length - 1 - i : i;
        const std::string next = at + 1 < length ? "R" + std::to_string(at + 1) : ends ? "" : "R0";
        rules += "rule R" + std::to_string(at) + " -> cube" + (next.empty() ? "" : " : " + next) + "\n";
    }
    return "start S -> cube : R0\n" + rules;
}

TEST(Endless, IsFoundOfLongChainsAtOnce) {
    for (const bool backwards : {false, true}) {
        const double started = secondsOf(threadClock());
        const Checked ends = checkedBody(chain(40'000, true, backwards));
        EXPECT_EQ(ends.messages(), "");
        const Checked circle = checkedBody(chain(40'000, false, backwards));
        EXPECT_NE(circle.messages().find("'R0' (R0#1) -> 'R1' (R1#1) -> "), std::string::npos)
            << circle.messages().substr(0, 300);
        EXPECT_LT(circle.messages().size(), 2000u);
        EXPECT_LT(secondsOf(threadClock()) - started, boundSeconds(4)) << "quadratic work takes minutes";
    }
}

TEST(Unreachable, RulesAreWarnedOf) {
    const Checked c = checkedBody("start S -> cube : A\nrule A -> sphere\nrule B -> C\nrule C -> sphere\n");
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(),
              "warning: this rule never runs: no start leads to a 'B'\nwarning: this rule never runs: no start leads "
              "to a 'C'\n");
}

TEST(Unreachable, EndlessRulesHarmNobody) {
    const Checked c = checkedBody("start S -> cube\nrule B -> cube : B\n");
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(), "warning: this rule never runs: no start leads to a 'B'\n");
}

TEST(Unused, ParametersAreWarnedOf) {
    const Checked c = checkedBody("param a = 1\nparam b = 2\nstart S -> cube size b\n");
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(), "warning: nothing uses the parameter 'a'\n");
}

TEST(Unused, TerminalsAndMaterialsAreWarnedOf) {
    const Checked c = checkedBody(
        "material stone color #888888\nmaterial slate color #444444\nterminal pane, door color #aabbcc\n"
        "terminal slab = cube of stone\n// door\nstart S -> slab + pane at +y\n");
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(), "warning: nothing uses the material 'slate'\nwarning: nothing uses the terminal 'door'\n");
}

TEST(Live, NamesNearARulesAreWarnedOf) {
    EXPECT_EQ(checkedBody("start S -> cube : Cel\nrule Cell -> sphere\n").messages(),
              "warning: no rule matches 'Cel', so nothing will grow here\nwarning: this rule never runs: no start "
              "leads to a 'Cell'\n");
    EXPECT_EQ(checkedBody("start S -> cube : Done\n").messages(), "") << "recognised, and left as it is";
}

TEST(Shadowed, ARuleBehindOneThatAlwaysHoldsIsTold) {
    EXPECT_EQ(judged("rule A when 1 == 1 -> sphere\nrule A when 2 == 2 -> cube\n"),
              "warning: this rule never runs: the condition of the one of line 3 always holds\n");
    EXPECT_EQ(judged("rule A -> cube\nrule A when true -> sphere\n"),
              "warning: this rule never runs: the condition of the one of line 4 always holds\n");
    EXPECT_EQ(judged("rule A when 1 == 1 -> + cube at +x\nrule A when 2 == 2 -> + sphere at +y\n"),
              "warning: this rule runs only where the one of line 3 has no joint left: its condition always holds\n");
    EXPECT_EQ(judged("rule A when scope.x > 1 -> sphere\nrule A -> cube\n"), "");
    EXPECT_EQ(judged("rule A when false -> sphere\nrule A when 1 < 2 -> cube\n"), "")
        << "the second is the one that runs";
}

TEST(Shadowed, ANeighbourIsDrawnAgainstAPlainRule) {
    EXPECT_EQ(judged("rule A beside A -> sphere\nrule A -> cube\n"),
              "warning: this rule is drawn by weight against the one of line 4, also beside a 'A'\n");
    EXPECT_EQ(judged("rule A beside A when true -> sphere\nrule A -> cube\n"), "");
    EXPECT_EQ(judged("rule A beside A -> sphere\n"), "");
}

TEST(Shares, OfAStartsOwnScopeAreTold) {
    EXPECT_EQ(checkedBody("start A -> cube size 50%\n").messages(),
              "warning: a share of what? A start's own scope is 1m\n");
    EXPECT_EQ(checkedBody("start A -> cube size 4 move (50%, 0, 0)\n").messages(),
              "warning: a share of what? A start's own scope is 1m\n");
    EXPECT_EQ(checkedBody("start A -> cube + cube size 50% at +x\n").messages(), "");
    const auto roofed = [](const std::string& size) {
        return checked("grammar 2\nstart A -> cube size (8, 15, 8) + cube size " + size + " at +y\n").messages();
    };
    EXPECT_EQ(roofed("(100%, 6m, 100%)"), "warning: a share of what? A start's own scope is 1m\n");
    EXPECT_EQ(roofed("100%"), "");
    EXPECT_EQ(checkedBody("start A -> size 4 cube size 50%\n").messages(), "");
}

TEST(Unsized, SolidsThatJoinASizedOneInAStartAreTold) {
    const std::string told = "warning: 'sphere' has no size, and a start's own scope is 1m\n";
    EXPECT_EQ(checked("grammar 2\nstart A -> cube size 4 + sphere at +y\n").messages(), told);
    EXPECT_EQ(checked("grammar 2\nstart A -> footprint rect(9, 8) extrude 5m cube + sphere\n").messages(), told);
    EXPECT_EQ(checked("grammar 2\nstart A -> cube size 4 + sphere size 2 at +y\n").messages(), "");
    EXPECT_EQ(checked("grammar 2\nstart A -> cube size 4 + sphere at +y on last\n").messages(), "");
    EXPECT_EQ(checked("grammar 2\nstart A -> cube + sphere at +y\n").messages(), "");
    EXPECT_EQ(checked("grammar 2\nstart A -> B size 4\nrule B -> cube + sphere at +y\n").messages(), "");
    EXPECT_EQ(checked("grammar 2\nstart A -> cube size 4 + B at +y\nrule B -> sphere\n").messages(),
              "warning: 'B' has no size, and a start's own scope is 1m\n");
    const auto& roof = checked("grammar 2\nstart A -> cube size (7, 3, 6) + gableRoof(45deg) at +y\n");
    ASSERT_EQ(roof.diagnostics.all().size(), 1u);
    EXPECT_NE(roof.diagnostics.all()[0].hint.find("'size (4, 100%, 4)'"), std::string::npos)
        << "its pitch is its height";
    EXPECT_EQ(checked("grammar 2\nstart A -> cube size 4 + B at +y\nrule B -> sphere size 3\n").messages(), "");
}

TEST(Doubts, OfConstantsAreToldAtOnce) {
    EXPECT_EQ(checkedBody("start A -> cube color rgb(255, 0, 0)\n").messages(),
              "warning: 'rgb' takes shares 0 … 1, but this is 255\n");
    EXPECT_EQ(checkedBody("start A -> cube move (4 / 0, 0, 0)\n").messages(), "warning: divided by 0\n");
    for (const char* text : {"start A -> cube size (5, 3, 3m / 0 + 2m)\n", "let q = 3m / 0\nstart A -> cube size q\n",
                             "start A -> cube size (5 % 0)\n"})
        EXPECT_EQ(checked(std::string("grammar 2\n") + text).messages(), "divided by 0\n") << text;
    EXPECT_EQ(checkedBody("start A -> cube move (sqrt(-1), 0, 0)\n").messages(),
              "warning: square root of a negative number: -1\n");
    EXPECT_EQ(checkedBody("param at = 3\nstart A -> cube size at\n").messages(),
              "warning: 'at' is an operation as well: 'size at …' is hard to read\n");
    EXPECT_EQ(checkedBody("param blend = 3\nstart A -> cube size blend\n").messages(), "");
}

}  // namespace
}  // namespace sgm::rules
