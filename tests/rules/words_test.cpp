// What a grammar's text is told where it means something else than its author.
#include "grammar/syntax/parser.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

/// "line:column message; hint" of all problems of a text, one a line.
std::string told(const std::string& body) {
    syntax::Diagnostics diagnostics;
    const auto source = std::make_shared<const syntax::Source>("test.sgm", "grammar 2\n" + body);
    rules::load(source, operations::table(), nullptr, diagnostics);
    std::string text;
    for (const auto& d : diagnostics.all()) {
        const auto place = d.span.source->place(d.span.begin);
        text += std::to_string(place.line) + ":" + std::to_string(place.column) + " " + d.message;
        text += (d.hint.empty() ? "" : "; " + d.hint) + "\n";
    }
    return text;
}

TEST(Told, WhatANameMeansAlready) {
    EXPECT_EQ(told("start A -> let step = 2m P with step = step\nrule P -> cube size step\n"),
              "2:16 'step' names a value that a 'with' sets; give the value another name\n");
    EXPECT_EQ(told("param step = 1m in 1..2m\nstart A -> let step = 2m cube size step\n"),
              "3:16 'step' names a parameter (line 2); give the value another name\n");
}

TEST(Told, AnOverhangOfNoThickness) {
    const auto roof = [](const std::string& written) { return told("start A -> " + written + " size (9, 4, 9)\n"); };
    EXPECT_EQ(roof("domeRoof(overhang: 1m)"),
              "2:31 this overhang does nothing: the eaves of a domeRoof have no thickness; give them a board, such as "
              "'fascia: .2m'\n");
    EXPECT_NE(roof("bellRoof(1m, 0m)"), "");
    for (const char* fine : {"bellRoof(1m, .2m)", "domeRoof(overhang: 0m)", "domeRoof", "pyramidRoof(overhang: 1m)"})
        EXPECT_EQ(roof(fine), "") << fine;
}

TEST(Told, ASymbolBehindAShape) {
    EXPECT_EQ(told("start A -> cube size 3 B\nrule B -> cube\n"),
              "2:24 'B' can't follow a shape; write ': B' to call this shape so, or ', B' for one beside it\n");
}

TEST(Told, BracketsOfLsystemsThatDoNotMatch) {
    const std::string rest = "\nstart A -> footprint P extrude 3m block\n";
    EXPECT_EQ(told("lsystem P passes 2 angle 90deg step 3m\n  axiom \"F+F[+F\"" + rest).substr(0, 31),
              "3:9 a '[' here is never closed;");
    EXPECT_EQ(told("lsystem P passes 2 angle 90deg step 3m\n  axiom \"F+F\"\n  F -> \"F]F\"" + rest).substr(0, 36),
              "4:3 a ']' here has no '[' before it;");
    EXPECT_EQ(told("lsystem P passes 2 angle 90deg step 3m\n  axiom \"F+F[+F]\"" + rest), "");
}

TEST(Told, SharesOfAStartInSums) {
    EXPECT_EQ(told("start A -> cube size (10, 3m + 30%, 5m)\n"),
              "2:17 a share of what? A start's own scope is 1m; write lengths, such as '.5m' for 50%\n");
    EXPECT_EQ(told("start A -> cube size (10, 100%, 5m)\n"), "");
    EXPECT_EQ(told("start A -> cube size 4m + sphere size 50% at +y\n"),
              "2:34 a share of what? A start's own scope is 1m; write lengths, such as '.5m' for 50%\n");
    EXPECT_EQ(told("start A -> cube size 4m + sphere size 50% at +y on last\n"), "");
    EXPECT_EQ(told("start A -> size 4m cube size 90% - sphere size 50%\n"),
              "2:43 a share of what? A start's own scope is 1m; write lengths, such as '.5m' for 50%\n");
}

TEST(Told, HeightsThatSomethingElseDecides) {
    const std::string roof =
        "the height of this size does nothing: 'hipRoof' is as high as its parameters make it; write '100%' for it\n";
    EXPECT_EQ(told("start A -> cube size 9m + hipRoof size (9m, 3m, 9m) at +y\n"), "2:35 " + roof);
    EXPECT_EQ(told("start A -> cube size 9m + hipRoof size (9m, 100%, 9m) at +y\n"), "");
    EXPECT_EQ(told("start A -> hipRoof(35deg) size (10m, 9m, 12m), size (10m, 9m, 12m) hipRoof\n"), "")
        << "it says where the foot stands";
    EXPECT_EQ(told("start A -> size (1m, 4m, 1m) cylinder from (0, -50%, 0) to (0, 50%, 0)\n"), "");
    EXPECT_EQ(told("start A -> cube from (0, 0, 0) to (3m, 4m, 0) size (.2m, 3m, .2m)\n"),
              "2:47 the height of this size does nothing: 'from … to …' says how long the shape is; write '100%' for "
              "it\n");
    EXPECT_EQ(told("start A -> cube from (0, 0, 0) to (3m, 4m, 0) size (.2m, 100%, .2m)\n"), "");
}

TEST(Told, ChoicesInOtherLanguagesWords) {
    EXPECT_EQ(told("param wall = brick | stone | wood\nstart A -> cube\n").substr(0, 93),
              "2:20 choices are listed behind 'of'; write 'param wall = brick of brick, stone, wood'\n");
    EXPECT_EQ(told("param wall = brick of brick, stone\nstart A -> B\nrule B when wall == \"brick\" -> cube\n"
                   "rule B -> sphere\n"),
              "4:21 a choice is written without quotes; write 'brick'\n");
}

TEST(Told, SizesAndRangesThatAreNone) {
    EXPECT_NE(told("start A -> cube size (10, 3)\n").find("; write all three, x, y and z"), std::string::npos);
    EXPECT_NE(told("start A -> cube size 5deg\n").find("; write a length such as '5m'"), std::string::npos);
    EXPECT_NE(told("start A -> for k in 1...3 { cube move (k, 0, 0) }\n").find("; a range has two dots, as in '1..3'"),
              std::string::npos);
}

TEST(Told, AFractionInARangeIsNoThirdDot) {
    EXPECT_NE(told("start A -> for k in .5..3 { cube move (k, 0, 0) }\n").find("; write 'round(…)' around it"),
              std::string::npos);
}

TEST(Told, AngleUnitsCountForTheWholeParameter) {
    for (const char* range : {"30 in 0deg..90deg", "30deg in 0..90", "30 in 0..90deg"}) {
        const std::string text = std::string("param ang = ") + range + "\nstart A -> cube turn ang\n";
        EXPECT_EQ(told(text), "");
        EXPECT_NEAR(grammarOf("grammar 2\n" + text)->params[0].value.num(), .5235987755982988, 1e-12) << range;
        EXPECT_NEAR(grammarOf("grammar 2\n" + text)->params[0].hi->num(), 1.5707963267948966, 1e-12) << range;
    }
    EXPECT_NE(told("param pc = 20 in 0..100%\nstart A -> cube size pc\n").find("; write '20%'"), std::string::npos);
}

TEST(Told, PlainLengthsBesideOtherUnits) {
    const std::string rest = "\nstart A -> cube size w\n";
    EXPECT_EQ(told("param w = 5 in 1cm..2000cm" + rest), "2:11 '5' beside cm is 5m; say its unit: '5cm' or '5m'\n");
    EXPECT_EQ(told("param w = 5cm in 0..2000cm" + rest), "");
    EXPECT_EQ(told("param w = 5 in 1..20m" + rest), "");
}

TEST(Told, LettersThatNeverStandInAnLsystem) {
    const std::string plan = "lsystem P passes 2 angle 90deg step 3m\n  axiom \"F(3)+X\"\n",
                      rest = "start A -> size 9 turtle P { F: cube | L: sphere }\n";
    EXPECT_EQ(told(plan + "  X -> \"XL\"\n" + rest), "");
    EXPECT_EQ(
        told(plan + "  X -> \"F(2)\"\n  Y -> \"L\"\n" + rest),
        "5:3 no 'Y' ever stands in 'P', so this production is never applied; write the letter into the axiom or "
        "into a production that is applied\n"
        "6:40 no 'L' ever stands in 'P', so this part draws nothing; write L into the axiom or into a production\n");
    EXPECT_EQ(
        told(plan + "  X -> \"L\"\n  F -> \"FF\"\n" + rest),
        "5:3 'F' never has 0 numbers in 'P', so this production is never applied; it stands there with 1 number\n");
}

TEST(Told, ValuesOfWithThatNothingReads) {
    EXPECT_EQ(told("start A -> cube with k = 3 : B\nrule B -> + cube size k at +x\n"), "");
    EXPECT_EQ(told("start A -> cube with k = 3 : B\nrule B when k > 2 -> + cube at +x\n"), "");
    EXPECT_EQ(told("start A -> cube with side = +x : B\nrule B -> + cube at side\n"), "");
    EXPECT_EQ(told("start A -> cube with k = 3 : B\nrule B -> + cube at +x\n"),
              "2:22 nothing reads 'k', which 'with' sets for the shapes below\n");
    EXPECT_EQ(told("start A -> cube with color = #aabbcc\n"),
              "2:22 nothing reads 'color', which 'with' sets for the shapes below; write 'color …' without 'with' and "
              "'='\n");
}

TEST(Told, ZeroIsAShareInOutlines) {
    EXPECT_EQ(
        told("start A -> size 8 B\nrule B -> footprint outline((0, 0), (50%, 0), (50%, 100%)) extrude 3m block\n"), "");
    EXPECT_EQ(
        told("start A -> size 8 B\nrule B -> footprint outline((0, 0), (50%, 50%), (4m, 2m)) extrude 3m block\n"),
        "3:49 the points of an outline are all lengths or all shares of the scope; write shares here too, such as "
        "'(50%, 25%)'\n");
}

}  // namespace
}  // namespace sgm
