// `split`: absolute, relative and floating sizes, repetition to fit, and what becomes of too little room.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

/// Least and greatest coordinate of every solid along an axis, in tree order.
std::vector<std::pair<double, double>> extents(const derive::Derivation& d, int axis) {
    std::vector<std::pair<double, double>> out;
    for (derive::ShapeId s = 0; s != derive::none; s = d.tree.next(s)) {
        const derive::Scope& scope = d.tree.shapes[s].scope;
        if (d.tree.shapes[s].solid != derive::none)
            out.emplace_back(scope.centre[axis] - scope.half()[axis], scope.centre[axis] + scope.half()[axis]);
    }
    return out;
}

void expectCuts(const std::string& body, std::vector<double> lengths, double from = -5) {
    SCOPED_TRACE(body);
    const auto found =
        extents(derived("grammar 1\nparam pane = 2m in 0m..4m\nstart A -> size (10, 3, 2) " + body + "\n"), 0);
    ASSERT_EQ(found.size(), lengths.size());
    for (size_t i = 0; i < lengths.size(); ++i) {
        EXPECT_NEAR(found[i].first, from, 1e-9) << i;
        EXPECT_NEAR(found[i].second, from += lengths[i], 1e-9) << i;
    }
}

TEST(Split, AbsoluteRelativeAndFloatingSizes) {
    expectCuts("split x { 1m: cube | 30%: cube | ~1: cube }", {1, 3, 6});
    expectCuts("split x { ~1: cube | 4: cube | ~2: cube }", {2, 4, 4});
    expectCuts("split x { ~1: cube | pane: cube | ~1: cube }", {4, 2, 4});
}

TEST(Split, RepeatsToFit) {
    expectCuts("split x { { ~3m: cube }* }", {10 / 3.0, 10 / 3.0, 10 / 3.0});
    expectCuts("split x { 1m: cube | { ~2.4m: cube }* | 1m: cube }", {1, 8 / 3.0, 8 / 3.0, 8 / 3.0, 1});
    expectCuts("split x { { 1m: cube | ~2m: cube }* }", {1, 7 / 3.0, 1, 7 / 3.0, 1, 7 / 3.0});
    expectCuts("split x { { 3m: cube }* }", {3, 3, 3});           // what doesn't give way leaves a rest
    expectCuts("split x { 8m: cube | { ~9m: cube }* }", {8, 2});  // alone it comes at least once
    expectCuts("split x { 8m: cube | { ~9m: cube }* | ~1: cube }", {8, 2});
    expectCuts("split x { { (i * 1m): cube }* }", std::vector<double>(10, 1));  // sizes are those of the first time
    const auto grown = extents(
        derived("grammar 1\nstart A -> size (10, 3, 2) split x { { 2m: cube size (100%, i * .1m, 1m) }* }\n"), 1);
    ASSERT_EQ(grown.size(), 5u);
    for (size_t k = 0; k < 5; ++k) EXPECT_NEAR(grown[k].second, (k + 1) * .05, 1e-9);
}

TEST(Split, WhatIsBeyondTheScopeIsCutOff) {
    expectCuts("split x { 8m: cube | 4m: cube | 1m: cube | ~1: cube }", {8, 2});
    expectCuts("split x { 0m: cube | ~0: cube | 10m: cube }", {10});
}

TEST(Split, PartsAreSplitAgainAndTurnWithTheirScope) {
    const auto d = derived(R"(grammar 1
start Front -> size (9, 8, 1) turn 90deg split y { 2m: cube | { ~3m: Row }* }
rule Row -> split x { { ~3m: Tile }* }
rule Tile -> cube size (100%, 50%, 100%)
)");
    EXPECT_EQ(d.terminals(), 7u);
    const derive::Scope& last = at(d, "Front/split/Row[2]/split/Tile[3]/cube").scope;
    expectNear(last.size, {3, 1.5, 1});
    expectNear(last.centre, {0, 2.5, -3});  // local x points to -z
    EXPECT_EQ(d.overlaps(), 0u);
    EXPECT_EQ(d.floating(), 6u);  // tiles of half the height hang above each other
}

TEST(Split, ANewcomerMayBeSplitAndCut) {
    const auto d = derived(
        "grammar 1\nstart A -> cube size 4 - split y { ~1: nil | 1m: cube | ~1: nil } size (4, 4, 9) at centre + cube "
        "size 1 at +y\n");
    expectNear(at(d, "A/cube/split/cube").scope.size, {4, 1, 9});
    EXPECT_EQ(at(d, "A/cube/split").op, rules::Operator::Difference);
    expectNear(at(d, "A/cube/cube").scope.centre, {0, 2.5, 0});
}

TEST(Split, DrawsOfOnePartLeaveTheOthersAlone) {
    const auto sizes = [](const std::string& parts) {
        return extents(derived("grammar 1\nstart A -> size 10 split y { " + parts + " }\n", withSeed(3)), 0);
    };
    const auto two = sizes("5m: cube size (1..4, 1, 1) | 5m: cube size (1..4, 1, 1)");
    const auto more = sizes("5m: cube size (1..4, 1, 1) | 5m: cube size (1..2, 1, 1)");
    EXPECT_EQ(two[0], more[0]);
    EXPECT_NE(two[0], two[1]);
}

TEST(Split, RepeatingNothingIsAnErrorAndEndlessRepeatsEndInTheBudget) {
    const auto nothing = tryDerive("grammar 1\nparam w = 0m in 0m..1m\nstart A -> split x { { w: cube }* }\n");
    ASSERT_FALSE(nothing.ok());
    EXPECT_EQ(nothing.error().kind, Error::Kind::Input);
    EXPECT_NE(nothing.error().message.find("test.sgm:3:"), std::string::npos) << nothing.error().message;
    derive::Options few;
    few.budget.shapes = 2000;
    const auto endless = tryDerive("grammar 1\nstart A -> size 1000000 split x { { 0.00001m: cube }* }\n", few);
    ASSERT_FALSE(endless.ok());
    EXPECT_EQ(endless.error().kind, Error::Kind::Budget);
}

}  // namespace
}  // namespace sgm
