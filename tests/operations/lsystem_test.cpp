// L-systems that draw plans.
#include <gtest/gtest.h>

#include <map>

#include "grammar/derive/lsystem.h"
#include "tests/derive/grammars.h"

namespace sgm::testing_ {
namespace {

/// The first L-system of a grammar, and where its numbers stand.
struct Grown {
    std::shared_ptr<const rules::Grammar> grammar;
    std::vector<rules::Value> params;
    derive::Place place;

    explicit Grown(const std::string& lsystem, uint64_t key = 1)
        : grammar(grammarOf("grammar 1\n" + lsystem + "\nstart A -> cube\n")) {
        for (const auto& p : grammar->params) params.push_back(p.value);
        place.params = params;
        place.key = key;
    }
    const rules::Lsystem& lsystem() const { return grammar->lsystems.at(0); }
    std::string letters() const {
        const auto text = derive::rewritten(lsystem(), place);
        return text.ok() ? *text : text.error().message;
    }
    plan::Footprint outline() const {
        auto drawn = derive::drawOutline(lsystem(), place);
        EXPECT_TRUE(drawn.ok()) << drawn.error().message;
        return drawn.ok() ? *drawn : plan::Footprint{};
    }
};

TEST(Lsystems, RewriteInParallel) {
    EXPECT_EQ(Grown("lsystem Algae passes 5\n  axiom \"A\"\n  A -> \"AB\"\n  B -> \"A\"").letters(), "ABAABABAABAAB");
    EXPECT_EQ(Grown("lsystem Koch passes 1\n  axiom \"F+F\"\n  F -> \"F-F\"").letters(), "F-F+F-F");
    EXPECT_EQ(Grown("lsystem Still passes 0\n  axiom \"AB\"\n  A -> \"AA\"").letters(), "AB");
}

TEST(Lsystems, DrawByWeight) {
    std::map<std::string, int> counts;
    for (uint64_t key = 0; key < 4000; ++key)
        ++counts[Grown("lsystem Plan passes 1\n  axiom \"F\"\n  F -> \"A\" : 3\n  F -> \"B\" : 1\n  F -> \"C\" : 0",
                       key)
                     .letters()];
    EXPECT_EQ(counts.size(), 2u);
    EXPECT_NEAR(counts["A"], 3000, 110);  // four standard deviations
}

TEST(Lsystems, ASquareIsClosedAndTagged) {
    const plan::Footprint square = Grown("lsystem Plan passes 0 angle 90deg step 4m\n  axiom \"F+FKB+F\"").outline();
    EXPECT_NEAR(area(square), 16, 1e-4) << "the last wall encloses it";
    size_t tagged = 0;
    for (const auto& edge : edgesOf(square)) tagged += square.tags[edge.edge.tag] == "K B";
    EXPECT_EQ(tagged, 1u);
}

TEST(Lsystems, ParametersAreSettings) {
    const plan::Footprint small =
        Grown("param n = 3m in 1m..9m\nlsystem Plan passes 0 angle 90deg step n\n  axiom \"F+F+F+F\"").outline();
    EXPECT_NEAR(area(small), 9, 1e-4);
    const plan::Footprint shrinking =
        Grown("lsystem Plan passes 0 angle 90deg step 4m shrink 1m\n  axiom \"F+F+F\"").outline();
    EXPECT_NEAR(area(shrinking), 4 * 3 - (4 - 2) * 3 / 2., 1e-4) << "4, 3, 2 and what encloses them";
}

TEST(Lsystems, CrossingWallsAreResolved) {
    const plan::Footprint star = Grown("lsystem Star passes 0 angle 144deg step 6m\n  axiom \"F+F+F+F+F\"").outline();
    EXPECT_EQ(star.edgeCount(), 10u);
}

TEST(Lsystems, TooManyLettersAreABudget) {
    const Grown bomb("lsystem Bomb passes 60\n  axiom \"F\"\n  F -> \"FFFF\"");
    const auto text = derive::rewritten(bomb.lsystem(), bomb.place);
    ASSERT_FALSE(text.ok());
    EXPECT_EQ(text.error().kind, Error::Kind::Budget);
}

TEST(Lsystems, FootprintsStandOnThem) {
    const auto d = derived(
        "grammar 1\nlsystem Plan passes 1 angle 90deg step 3m\n  axiom \"F+F+F+F\"\n  F -> \"FF\"\nterminal wall\n"
        "start A -> footprint Plan extrude 3m wall\n");
    expectNear(d.tree.shapes.back().scope.size, {6, 3, 6}, 1e-5);
}

TEST(Lsystems, WallsOnOneLineDrawNoPlan) {
    const auto d =
        tryDerive("grammar 1\nlsystem Line passes 0\n  axiom \"FFF\"\nterminal wall\nstart A -> footprint Line wall\n");
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("on one line"), std::string::npos) << d.error().message;
}

}  // namespace
}  // namespace sgm::testing_
