// What a derivation does that is hardly meant, and says.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

std::string told(const std::string& body) { return warningsOf(derived("grammar 1\n" + body)); }

TEST(Warnings, ACutThatRemovesNothingIsTold) {
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> - cube size 1 move (9,0,0)\n"),
              "3:11 this cuts nothing: it lies beside 'B'\n");
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> - cube size 1 move (2,0,0)\n"), "");
    EXPECT_EQ(told("start A -> cube size (8, 6, .6) : B\nrule B -> + Front size (100%, 100%, .6m)\n"
                   "rule Front -> split x { { ~2m: Win }* }\nrule Win -> - cube size (1m, 3m, 300%)\n"),
              "5:13 this cuts nothing: 'Win' holds no solid before it\n");
    EXPECT_EQ(told("start A -> cube size (8, 6, .6) : B\nrule B -> - Front size (100%, 100%, .6m)\n"
                   "rule Front -> split x { { ~2m: Win }* }\nrule Win -> cube size (1m, 3m, 300%)\n"),
              "");
}

TEST(Warnings, ACutThatRemovesSomethingSomewhereIsFine) {
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> for k in 0..3 { - cube size 1 move (3 * k, 0, 0) }\n"), "");
    EXPECT_EQ(told("start A -> cube size 4 - (cube size 1 move (9,0,0), cube size 1)\n"), "")
        << "a part of the cutter reaches it";
    EXPECT_EQ(told("start A -> cube size 4 - halfspace move (0, 1, 0)\n"), "") << "without bounds";
    EXPECT_EQ(told("start A -> cube size 4 displace billow(1m, 1/m) - cube size 1 move (0, 2.6, 0)\n"), "")
        << "noise reaches out of its box";
}

TEST(Warnings, DivisionByZeroNamesTheDivisor) {
    EXPECT_EQ(told("param n = 0 in 0..4\nstart A -> cube size 2 move (4 / n, 0, 0)\n"),
              "3:30 divided by 0: 'n' is 0\n");
    EXPECT_EQ(told("param n = 0 in 0..4\nstart A -> cube size 2 move (5 % n, 0, 0)\n"),
              "3:30 divided by 0: 'n' is 0\n");
    EXPECT_EQ(told("param n = 0 in 0..4\nstart A -> cube size 2 move (if(n > 0, 4 / n, 0), 0, 0)\n"), "")
        << "not taken";
    EXPECT_EQ(told("param n = 0 in 0..4\nstart A -> cube for k in 1..9 { + cube move (4 / n, k, 0) }\n"),
              "3:46 divided by 0: 'n' is 0\n")
        << "once a place";
}

TEST(Warnings, ValuesBeyondTheirRangeAreTold) {
    const auto at = [](double t, const std::string& body) {
        derive::Options options;
        options.params = {rules::Value::number(t)};
        return warningsOf(derived("grammar 2\nparam t = .5 in -9..9\nstart A -> cube size 4 : B\n" + body, options));
    };
    for (const auto& [body, told] :
         {std::pair("rule B -> torus(t)\n", "4:17 'tube' of 'torus' is -5, but must be 0.02 … 0.5\n"),
          {"rule B -> morph(cube, sphere, t)\n", "4:31 the morph's share is -5, but must be 0 … 1\n"},
          {"rule B -> morph sphere by t\n", "4:27 'by' is -5, but must be 0 … 1\n"},
          {"rule B -> + sphere size 1 at +y blend (t * 1m)\n", "4:39 'blend' is -5m, but must be no less than 0m\n"},
          {"rule B -> cube rough t\n", "4:22 'rough' is -5, but must be 0 … 1\n"},
          {"rule B -> sphere displace fbm(.1m, 2/m, 1 + floor(t))\n",
           "4:41 the number of octaves is -4, but must be 1 … 8\n"}}) {
        EXPECT_EQ(at(-5, body), told);
        EXPECT_EQ(at(body[10] == 's' ? 2 : .5, body), "") << body;
    }
}

TEST(Warnings, PartsOfNegativeSizeAreTold) {
    EXPECT_EQ(told("start A -> size (6, 2, 2) split x { 2m: cube | scope.x - 9m: sphere | ~1: cube }\n"),
              "2:48 the size of a part is -3m here, so the part is left out\n");
    EXPECT_EQ(told("start A -> size (9, 2, 2) split x { 2m: cube | scope.x - 9m: sphere | ~1: cube }\n"), "");
}

TEST(Warnings, GapsOfARowAreNoLessThanNothing) {
    const std::string row = "param g = 1m in -3m..3m\nstart A -> size (10, 2, 2) row 4 along x gap g { cube }\n";
    derive::Options options;
    options.params = {rules::Value::number(-1, rules::Unit::Metre)};
    const auto refused = tryDerive("grammar 2\n" + row, options);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("'gap' is -1m, but must be no less than 0"), std::string::npos)
        << refused.error().message;
    EXPECT_TRUE(tryDerive("grammar 1\n" + row, options).ok());
}

TEST(Warnings, RootsRepeatsAndColours) {
    EXPECT_EQ(told("param n = -4 in -4..4\nstart A -> cube move (sqrt(n), 0, 0)\n"),
              "3:23 square root of a negative number: -4\n");
    EXPECT_EQ(told("param n = 2 in -3..4\nstart A -> cube : B\nrule B repeat n - 4 -> + cube at +x : B\n"),
              "4:15 'repeat' is -2 here, so the rule adds nothing\n");
    EXPECT_EQ(told("param n = 200 in 0..255\nstart A -> cube color rgb(n, 0, 0)\n"),
              "3:27 'rgb' takes shares 0 … 1, but this is 200\n");
}

TEST(Warnings, WhatAClosedJointKeepsFromGrowingIsAmongThem) {
    EXPECT_EQ(told("start A -> cube size 2 : B\nrule B -> + cube size (2,1,1) at +x + sphere size 3 at +x\n"),
              "3:37 '+x' of 'A/B' is closed by 'A/B/cube', made by rule 'B#1' (test.sgm:3), so this grows nowhere\n");
    EXPECT_EQ(told("start A -> cube size 2 + cube size 1 at free(-y) + sphere size 1 at free(-y)\n"),
              "2:50 none of these joints is free any more, so this grows nowhere: '-y' of 'A/cube' is closed by "
              "'A/cube/cube', made by the start (test.sgm:2)\n");
    EXPECT_EQ(told("start A -> cube size 2 : B, cube size 2 move (2, 0, 0)\nrule B -> + sphere size 3 at +x\n"),
              "3:11 '+x' of 'A/B' is closed by 'A/cube', made by the start (test.sgm:2), so this grows nowhere\n")
        << "faces that coincide";
    EXPECT_EQ(told("start A -> cube size 2 : B\nrule B -> cube size 2 : C + cube size 1 at -z : D\n"
                   "rule C -> cube size 2 + sphere size 9 at -z + sphere size 3 at +z\n"),
              "4:23 '-z' of 'A/B/group/C/cube' is closed by 'A/B/group/D', made by rule 'B#1' (test.sgm:3), so this "
              "grows nowhere\n")
        << "the shape that stood in the place before";
}

TEST(Warnings, CopiesThatAskForOneJointAreTold) {
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> for k in 1..3 { + cube size 1 at +y move (k, 0, 0) }\n"),
              "3:27 the first of these copies closes the joint that all ask for, so 2 grew nowhere\n");
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> for k in 1..3 { + cube size 1 move (k, 3, 0) }\n"), "");
    EXPECT_EQ(told("start A -> cube size 4 : B\nrule B -> for d in axes { + cube size 1 at d }\n"), "");
}

TEST(Warnings, HostsThatComeLaterAreTold) {
    const std::string halls =
        "rule Chain -> sphere size 4 : Hall\nrule Hall repeat 4 -> + sphere size 4 at +x : Hall\n";
    EXPECT_EQ(told("start A -> Chain - cube size 1 on each(Hall)\n" + halls),
              "2:32 no 'Hall' stands there yet, so this grows nowhere\n");
    EXPECT_EQ(told("start A -> Chain : B\nrule B when count(Hall) > 1 -> - cube size 1 on each(Hall)\n" + halls), "");
    EXPECT_EQ(told("param on = false\nstart A -> cube size 9 - cube size 1 on each(Hall) "
                   "when on { + Chain }\n" +
                   halls),
              "")
        << "none ever stands there";
}

TEST(Warnings, AShapeThatNoRuleMatchesIsTold) {
    const std::string split = "start A -> size 4 split x { ~1: cube | 1m: N | 1m: N | ~2: N }\n";
    EXPECT_EQ(told(split + "rule N when scope.x > 3 -> cube\n"), "3:13 a 'N' that no rule matches stays empty\n");
    EXPECT_EQ(told(split + "rule N when scope.x > 1 -> cube\n"), "3:13 a 'N' that no rule matches stays empty\n");
    EXPECT_EQ(told(split + "rule N when scope.x > 3 -> cube\nrule N -> nil\n"), "");
    EXPECT_EQ(told("start A -> cube : N\nrule N when scope.x > 3 -> + cube at +x : N\n"), "") << "the cube stands";
    EXPECT_EQ(told("param on = false\nstart A -> size 4 split x { ~1: cube | 1m: N }\nrule N when on -> cube\n"), "")
        << "a switch";
    EXPECT_EQ(told("start A -> cube size 4 : T\nrule T when scope.x > 1 -> cube + T size 50% at +y\n"), "")
        << "a recursion that ends";
    EXPECT_EQ(told("start A -> cube size 3 + N at +y\nrule N beside Gate -> cube size 1\nrule Gate -> cube\n"),
              "3:6 a 'N' that no rule matches stays empty\n");
}

TEST(Warnings, ATurnThatTheJointUndoesIsTold) {
    const std::string lost = " the joints face each other all the same: only the turn about them is left\n",
                      start = "start A -> cube size 2 : B\nrule B -> + cube size (.5, 3, .5) at ";
    EXPECT_EQ(told(start + "+y turn (30deg, 0deg, 0deg)\n"), "3:41" + lost);
    EXPECT_EQ(told(start + "+y turn (30deg, 40deg, 0deg)\n"), "3:41" + lost);
    EXPECT_EQ(told(start + "+x to -y turn (0deg, 0deg, 30deg)\n"), "3:47" + lost);
    EXPECT_EQ(told(start + "+y turn 40deg\n"), "") << "about the joint";
    EXPECT_EQ(told(start + "+y turn (90deg, 0deg, 0deg)\n"), "") << "another face takes the joint's place";
    EXPECT_EQ(told(start + "+x to -y turn 40deg\n"), "") << "about its own joint";
    EXPECT_EQ(told(start + "centre turn (30deg, 0deg, 0deg)\n"), "") << "a centre faces nowhere";
    EXPECT_EQ(told("start A -> cube size 2 + (cube turn (30deg, 0deg, 0deg)) size (.5, 3, .5) at +y\n"), "")
        << "the fix";
}

TEST(Warnings, ASplitThatOverflowsIsTold) {
    EXPECT_EQ(told("start A -> size 10 split x { 8m: cube | 8m: sphere }\n"),
              "2:41 this part is cut off: 2m are left for its 8m\n");
    EXPECT_EQ(told("start A -> size 10 split x { 8m: cube | 2m: sphere }\n"), "");
    EXPECT_EQ(told("start A -> size 10 split x { ~8m: cube | ~8m: sphere }\n"), "");
    EXPECT_EQ(told("start A -> size 10 split x { 60%: cube | 60%: sphere }\n"),
              "2:42 this part is cut off: 4m are left for its 6m\n");
    EXPECT_EQ(told("start A -> size 10 split x { { 3m: cube }* | 1m: sphere }\n"), "");
    EXPECT_EQ(told("start A -> size 10 split x { 10m: cube | 1m: sphere }\n"),
              "2:42 this part is cut off: 0m are left for its 1m\n")
        << "nothing of it is there";
}

TEST(Warnings, ALookThatNothingHasIsTold) {
    const std::string own = "terminal brick color #a04030\nterminal slate color #404850\n";
    const auto expected = [](const std::string& place, const std::string& names) {
        return place + " nothing has this look: all in it have looks of their own: " + names + "\n";
    };
    EXPECT_EQ(told(own + "start A -> size 4 (brick + slate size 2 at +y) color #ff0000\n"),
              expected("4:48", "'brick', 'slate'"));
    EXPECT_EQ(told(own + "start A -> size 4 B rough .3\nrule B -> split y { ~1: brick | ~1: slate }\n"),
              expected("4:21", "'brick', 'slate'"));
    EXPECT_EQ(told(own + "start A -> size 4 (brick - cube size 2 move (0, 2m, 0)) color #ff0000\n"),
              expected("4:57", "'brick'"))
        << "the cut looks like the brick";
    EXPECT_EQ(told(own + "start A -> size 4 (brick + cube size 2 at +y) color #ff0000\n"), expected("4:47", "'brick'"))
        << "the cube looks like the brick that it grows on";
    EXPECT_EQ(told(own + "start A -> size 4 ((cube + slate size 2 at +y) + brick size 2 at +x) color #ff0000\n"), "");
    EXPECT_EQ(told(own + "start A -> brick size 4 color #ff0000 rough .3\n"), "") << "its own";
    EXPECT_EQ(told(own + "start A -> for k in 0..1 { B move (9 * k, 0, 0) with n = k color #ff0000 }\n"
                         "rule B when n > 0 -> cube\nrule B -> brick\n"),
              "")
        << "taken somewhere";
}

TEST(Warnings, AFailureNamesWhatWasRemarkedInItsText) {
    const auto failed = derive::derive(
        grammarOf("grammar 1\nstart A -> cube with n = 1 : B\nrule B -> + cube size (4m / (1 - n)) at +x\n"), {},
        nullptr);
    ASSERT_FALSE(failed.ok());
    EXPECT_NE(failed.error().message.find("divided by 0: '(1 - n)' is 0"), std::string::npos) << failed.error().message;
}

}  // namespace
}  // namespace sgm
