// Splits whose parts repeat, snap, follow edges or have an area; reports.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "grammar/pipeline/checks.h"
#include "tests/lower/lowered.h"
#include "tests/operations/shapes_called.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::Shape;

Derivation cut(const std::string& block, const std::string& size = "(20, 3, 1)") {
    return derived("grammar 2\nterminal a\nterminal b\nterminal c\nstart S -> size " + size + " split " + block + "\n");
}

TEST(Repeats, DrawSizesForEveryRepetition) {
    const Derivation d = cut("x { { ~(1m..3m): a }* }");
    const auto parts = shapesCalled(d, "a");
    std::set<long> widths;
    double all = 0;
    for (const Shape& s : parts) {
        widths.insert(std::lround(s.scope.size.x * 1e6));
        all += s.scope.size.x;
        EXPECT_GT(s.scope.size.x, .7);
        EXPECT_LT(s.scope.size.x, 3.8);
    }
    EXPECT_GE(parts.size(), 6u);
    EXPECT_EQ(widths.size(), parts.size()) << "each has a width of its own";
    EXPECT_NEAR(all, 20, 1e-9);
}

TEST(Repeats, CanFollowTheNumberOfTheRepetition) {
    const Derivation d = cut("x { { (1m * i): a }* }");
    const auto parts = shapesCalled(d, "a");
    ASSERT_EQ(parts.size(), 5u) << "1 + 2 + 3 + 4 + 5 fit into 20";
    EXPECT_NEAR(parts[4].scope.size.x, 5, 1e-9);
}

TEST(Repeats, AsOftenAsIsSaid) {
    EXPECT_EQ(shapesCalled(cut("x { { 1m: a | .5m: b }3 | ~1: c }"), "a").size(), 3u);
    EXPECT_EQ(shapesCalled(cut("x { { ~1: a }(2 + 2) }"), "a").size(), 4u);
    EXPECT_EQ(shapesCalled(cut("x { { ~1: a }0 | ~1: b }"), "a").size(), 0u);
    EXPECT_EQ(shapesCalled(cut("x { { ~8m: a }* | ~12m: b | 5m: c }"), "a").size(), 0u);
    EXPECT_EQ(shapesCalled(cut("x { { ~8m: a }+ | ~12m: b | 5m: c }"), "a").size(), 1u);
}

TEST(Repeats, InsideRepeats) {
    // Three sections between piers, each with as many bays as fit.
    const Derivation d = cut("x { { 1m: a | { ~2m: b }* }3 | 1m: a }", "(22, 3, 1)");
    EXPECT_EQ(shapesCalled(d, "a").size(), 4u);
    EXPECT_EQ(shapesCalled(d, "b").size(), 9u);
    for (const Shape& s : shapesCalled(d, "b")) EXPECT_NEAR(s.scope.size.x, 2, 1e-9);
    const Derivation twice = cut("x { { { .5m: a }2 | ~1m: b }* }");
    EXPECT_EQ(shapesCalled(twice, "a").size(), 2 * shapesCalled(twice, "b").size());
}

TEST(Repeats, TwoThatFitOneInTheOtherAreRefused) {
    const auto source = std::make_shared<const syntax::Source>(
        "t.sgm", "grammar 1\nterminal a\nstart S -> split x { { { ~1m: a }* }* }\n");
    syntax::Diagnostics diagnostics;
    rules::load(source, operations::table(), rules::Loader(), diagnostics);
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_NE(diagnostics.all()[0].message.find("no lengths of their own"), std::string::npos);
}

TEST(Snap, CutsMoveToFacesWithinReach) {
    const std::string text =
        "grammar 1\nterminal pane\nterminal shop = cube\nstart S -> size (10, 4, 1) split y { 1m: Shops | ~1: Row }\n"
        "rule Shops -> split x { 2.3m: shop | 2.5m: shop | 2.7m: shop | 2.5m: shop }\n";
    const Derivation plain = derived(text + "rule Row -> split x { { ~2.5m: pane }* }\n");
    const Derivation snapped = derived(text + "rule Row after Shops -> split x { { ~2.5m: pane }* } snap shop .3m\n");
    const auto edges = [](const Derivation& d, const std::string& name) {
        std::vector<double> all;
        for (const Shape& s : shapesCalled(d, name)) all.push_back(s.scope.centre.x + s.scope.size.x / 2);
        return all;
    };
    EXPECT_NE(edges(plain, "pane"), edges(plain, "shop"));
    const auto tiles = edges(snapped, "pane"), shops = edges(snapped, "shop");
    ASSERT_EQ(tiles.size(), shops.size());
    for (size_t i = 0; i < tiles.size(); ++i) EXPECT_NEAR(tiles[i], shops[i], 1e-9);
    const Derivation late = derived(text + "rule Row after Shops -> split x { { ~2.5m: pane }* } snap shop .1m\n");
    EXPECT_EQ(edges(late, "pane"), edges(plain, "pane")) << "no face lies within reach";
}

TEST(Snap, WithoutShapesIsTold) {
    const Derivation d = derived(
        "grammar 1\nterminal pane\nterminal shop\nstart S -> size 4m split x { { ~1m: pane }* } snap shop .3m\n");
    ASSERT_EQ(d.warnings.size(), 1u);
    EXPECT_NE(d.warnings[0].message.find("no 'shop' stands yet"), std::string::npos);
}

TEST(SplitAlong, PartsStandOnTheirOwnChords) {
    const Derivation d = derived(
        "grammar 1\nterminal house\nstart S -> footprint arc(33m, 44m, 15deg, 130deg, 24) extrude 9m Row\n"
        "rule Row -> split along outer { { ~6m: house }* }\n");
    const auto houses = shapesCalled(d, "house");
    EXPECT_EQ(houses.size(), 15u);  // 44 m · 130° − 15° … in radians is 88.3 m
    double sum = 0, whole = 0;
    for (const Shape& s : houses) {
        ASSERT_NE(s.scope.footprint, derive::none);
        sum += area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
        EXPECT_NEAR(dot(cross(s.scope.axes.x, s.scope.axes.y), s.scope.axes.z), 1, 1e-9);
        EXPECT_GT(dot(s.scope.axes.z, Vec3d{s.scope.centre.x, 0, s.scope.centre.z} - d.tree.shapes[0].scope.centre),
                  -50);
    }
    for (const Shape& s : d.tree.shapes)
        if (s.symbol != rules::none && d.grammar->symbols[s.symbol].name == "Row")
            whole = area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
    EXPECT_NEAR(sum, whole, 1e-3);
}

TEST(SplitAlong, FixedLengthsAreThoseOfTheStreet) {
    const Derivation d = derived(
        "grammar 1\nterminal house\nstart S -> footprint rect(20, 8) extrude 9m Row\n"
        "rule Row -> split along front { 4m: house | 6m: house | ~1: house }\n");
    const auto houses = shapesCalled(d, "house");
    ASSERT_EQ(houses.size(), 3u);
    EXPECT_NEAR(houses[0].scope.size.x, 4, 1e-6);
    EXPECT_NEAR(houses[1].scope.size.x, 6, 1e-6);
    EXPECT_NEAR(houses[2].scope.size.x, 10, 1e-6);
    EXPECT_NEAR(houses[0].scope.axes.z.z, 1, 1e-9) << "z looks outward";
}

TEST(SplitAlong, NoSuchEdgeIsTold) {
    const Derivation d = derived("grammar 1\nterminal house\nstart S -> size 4m split along street { ~1: house }\n");
    ASSERT_EQ(d.warnings.size(), 1u);
    EXPECT_NE(d.warnings[0].message.find("no edge of this plan is called 'street'"), std::string::npos);
}

TEST(SplitArea, PartsHaveTheirAreas) {
    const Derivation d = derived(
        "grammar 1\nterminal lot\nterminal rest\nstart S -> footprint ell(40, 30, 12, 14) extrude 1m Block\n"
        "rule Block -> split area x { 200: lot | { ~150: lot }2 | 100: rest }\n");
    const auto areaOf = [&](const Shape& s) {
        return s.scope.footprint == derive::none ? s.scope.size.x * s.scope.size.z
                                                 : area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
    };
    const auto lots = shapesCalled(d, "lot");
    ASSERT_EQ(lots.size(), 3u);
    EXPECT_NEAR(areaOf(lots[0]), 200, 1e-3);
    EXPECT_NEAR(areaOf(lots[1]), areaOf(lots[2]), 1e-3);
    EXPECT_NEAR(areaOf(shapesCalled(d, "rest")[0]), 100, 1e-3);
}

TEST(Reports, AreSummedAndAskedByChecks) {
    const std::string text =
        "grammar 1\nterminal floor\nstart House -> size (10, 9, 8) Mass\nrule Mass -> split y { { 3m: Storey }* }\n"
        "rule Storey -> floor report gfa (scope.area) report storeys 1\n"
        "check House expect gfa == 240\ncheck House expect storeys == 4\n";
    const Derivation d = derived(text);
    EXPECT_EQ(d.reported(0).count, 3u);
    EXPECT_NEAR(d.reported(0).sum, 240, 1e-9);
    EXPECT_NEAR(d.reported(0).greatest, 80, 1e-9);
    pipeline::Context context;
    const auto verdicts = pipeline::runChecks(grammarOf(text), 1, context);
    ASSERT_TRUE(verdicts.ok());
    EXPECT_TRUE((*verdicts)[0].passed) << (*verdicts)[0].message;
    EXPECT_FALSE((*verdicts)[1].passed);
    EXPECT_NE((*verdicts)[1].message.find("storeys is 3"), std::string::npos) << (*verdicts)[1].message;
}

}  // namespace
}  // namespace sgm::testing_
