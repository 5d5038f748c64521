// overlaps, touches, inside, covered: what stands around a shape when a rule is chosen; rules that come after others.
#include <gtest/gtest.h>

#include "tests/derive/grammars.h"

namespace sgm::testing_ {
namespace {

uint64_t countOf(const derive::Derivation& d, const std::string& symbol) {
    uint64_t count = 0;
    for (const derive::Shape& s : d.tree.shapes)
        count += s.symbol != rules::none && d.grammar->symbols[s.symbol].name == symbol;
    return count;
}

std::string two(const std::string& first, const std::string& second, const std::string& guard) {
    return "grammar 1\nterminal yes = cube\nterminal no = cube\nterminal body\nstart S -> A " + first + ", B " +
           second + "\nrule B -> body\nrule A after B when " + guard + " -> yes\nrule A -> no\n";
}

TEST(Surroundings, VolumesDecide) {
    const auto holds = [](const std::string& a, const std::string& b, const std::string& guard) {
        return countOf(derived(two(a, b, guard)), "yes") == 1;
    };
    EXPECT_TRUE(holds("size 2m", "size 2m move (1.5, 0, 0)", "overlaps(B)"));
    EXPECT_FALSE(holds("size 2m", "size 2m move (2, 0, 0)", "overlaps(B)"));
    EXPECT_TRUE(holds("size 2m", "size 2m move (2, 0, 0)", "touches(B)"));
    EXPECT_FALSE(holds("size 2m", "size 2m move (2.01, 0, 0)", "touches(B)"));
    EXPECT_TRUE(holds("size 1m", "size 2m move (.5, 0, 0)", "inside(B)"));
    EXPECT_FALSE(holds("size 1m", "size 2m move (.6, 0, 0)", "inside(B)"));
    EXPECT_FALSE(holds("size 2m move (3, 0, 0)", "size 2m turn 45deg", "overlaps(B)"));
}

TEST(Surroundings, PlansDecideWhereThereAreSome) {
    // The small box stands in the notch of the L: the boxes overlap, the volumes don't.
    const std::string ell = "footprint ell(16, 12, 5, 5) extrude 2m ";
    const std::string rest = "\nrule B -> body\nrule A after B when overlaps(B) -> yes\nrule A -> no\n";
    const std::string head = "grammar 1\nterminal yes = cube\nterminal no = cube\nterminal body\nstart S -> ";
    EXPECT_EQ(countOf(derived(head + ell + "B, A size 2m move (5, .5, 4)" + rest), "yes") +
                  countOf(derived(head + ell + "B, A size 2m move (5, .5, -4)" + rest), "yes"),
              1u);
}

TEST(Surroundings, CoveredIsTheShareOfTheFace) {
    const auto covered = [](const std::string& box, const std::string& guard) {
        return countOf(derived(two("size 2m", box, guard)), "yes") == 1;
    };
    EXPECT_TRUE(covered("size 2m move (0, 0, 2)", "covered == 1"));
    EXPECT_TRUE(covered("size 2m move (0, 0, 2.1)", "covered == 0"));
    EXPECT_TRUE(covered("size 2m move (.8, 0, 2)", "covered == .6"));
    EXPECT_TRUE(covered("size (.3, 2, 2) move (.21, 0, 2)", "covered == .15"));
}

TEST(Surroundings, RulesWaitForShapesThatLive) {
    // Without `after` the tile is chosen while the annexe is no solid yet.
    const std::string text =
        "grammar 1\nterminal yes = cube\nterminal no = cube\nterminal body\nstart S -> Tile size 2m, Annexe size 2m "
        "move (0, 0, "
        "2)\nrule Annexe -> Later\nrule Later -> body\nrule Tile ";
    EXPECT_EQ(countOf(derived(text + "after Annexe when covered > 0 -> yes\nrule Tile after Later -> no\n"), "yes"),
              1u);
    EXPECT_EQ(countOf(derived(text + "when covered > 0 -> yes\nrule Tile -> no\n"), "yes"), 0u);
}

TEST(Surroundings, WhatHasNoRuleLeftIsNotWaitedFor) {
    const auto d = derived(
        "grammar 1\nterminal yes = cube\nstart S -> Tile, Stuck\nrule Stuck when count(yes) > 5 -> cube\nrule Tile "
        "after "
        "Stuck -> yes\n");
    EXPECT_EQ(countOf(d, "yes"), 1u);
}

TEST(Surroundings, TheOrderOfRulesDoesNotMatter) {
    const std::string head = "grammar 1\nterminal yes = cube\nterminal no = cube\nterminal body\n";
    const std::string a = "rule A after B when covered > .5 -> yes\nrule A -> no\n",
                      b = "rule B -> split x { 50%: body | ~1: nil }\n";
    const std::string start = "start S -> split x { { 1m: A }* }, B size 6m move (0, 0, 3.5)\n";
    EXPECT_EQ(derive::toText(derived(head + start + a + b), false),
              derive::toText(derived(head + start + b + a), false));
}

}  // namespace
}  // namespace sgm::testing_
