// tag: edges of a plan named by the grammar, and the operations that select edges by name.
#include <gtest/gtest.h>

#include <map>

#include "tests/derive/grammars.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::Shape;

std::map<std::string, int> solidsOf(const std::string& text) {
    const Derivation d = derived("grammar 2\nterminal wall\nterminal shop\nterminal lawn\n" + text);
    const syntax::Diagnostics told = derive::warnings(d);
    EXPECT_TRUE(told.all().empty()) << told.all()[0].message;
    std::map<std::string, int> count;
    for (const Shape& s : d.tree.shapes)
        if (s.solid != derive::none) ++count[d.tree.labels[s.label]];
    return count;
}

TEST(Tag, NamesAllEdgesOrThoseOfAWord) {
    using Count = std::map<std::string, int>;
    EXPECT_EQ(solidsOf("start A -> size (10, 4, 8) tag K faces .5m { K: shop | side: wall | rest: nil }\n"),
              (Count{{"shop", 4}}));
    EXPECT_EQ(
        solidsOf("start A -> footprint ell(16, 12, 5, 6) tag K along front faces .5m { K: shop | side: wall | rest: "
                 "nil }\n"),
        (Count{{"shop", 2}, {"wall", 4}}));
    EXPECT_EQ(
        solidsOf("start A -> footprint rect(20, 16) court 4m tag K along court faces .5m { K: shop | side: wall | "
                 "rest: nil }\n"),
        (Count{{"shop", 4}, {"wall", 4}}))
        << "'court' is an operation's word too";
}

TEST(Tag, AddsWordsAndKeepsThoseThatAre) {
    using Count = std::map<std::string, int>;
    const std::string plan = "start A -> footprint arc(20m, 32m, 20deg, 160deg, 4) tag K along outer tag L along K ";
    EXPECT_EQ(solidsOf(plan + "faces .5m { outer: shop | side: wall | rest: nil }\n"),
              (Count{{"shop", 4}, {"wall", 6}}));
    EXPECT_EQ(solidsOf(plan + "faces .5m { L: shop | side: wall | rest: nil }\n"), (Count{{"shop", 4}, {"wall", 6}}));
}

TEST(Tag, IsKeptByWhatIsCutFromThePlan) {
    using Count = std::map<std::string, int>;
    EXPECT_EQ(solidsOf("start A -> footprint tee(20, 12, 6, 6) tag street along front split x { ~1: Half | ~1: Half }\n"
                       "rule Half -> faces .5m { street: shop | cut: nil | side: wall | rest: nil }\n"),
              (Count{{"shop", 4}, {"wall", 6}}));
}

TEST(Tag, MakesStreetsForSetbacksAndLots) {
    const Derivation d = derived(
        "grammar 2\nstart A -> footprint rect(30, 20) tag street along front setback edges(street: 5m, rest: 2m) "
        "block\n");
    for (const Shape& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        EXPECT_NEAR(s.scope.size.x, 26, 1e-6);
        EXPECT_NEAR(s.scope.size.z, 13, 1e-6);
    }
    const auto lots = solidsOf(
        "start A -> size (60, 4, 40) tag street lots box(300, front: 8m) { lot: setback 2m wall | inner: lawn }\n");
    EXPECT_GE(lots.at("wall"), 6);
}

TEST(Tag, SaysWhereNoEdgeIsCalledSo) {
    const Derivation d = derived("grammar 2\nstart A -> size 4 tag K along fornt block\n");
    const syntax::Diagnostics told = derive::warnings(d);
    ASSERT_EQ(told.all().size(), 1u);
    EXPECT_EQ(told.all()[0].message, "no edge of this plan is called 'fornt', so none is called 'K'");
    EXPECT_EQ(told.all()[0].hint, "did you mean 'front'?");
}

}  // namespace
}  // namespace sgm::testing_
