// SG-M figure 1: both ways of deriving give the trees of eqs. 2–8.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

/// "I0 ∪ A ∪ …": the shapes with a solid, in tree order, as the paper writes its states.
std::string equation(const derive::Derivation& d) {
    std::string text;
    for (derive::ShapeId s = 0; s != derive::none; s = d.tree.next(s))
        if (d.tree.shapes[s].solid != derive::none)
            text += (text.empty() ? "" : " ∪ ") + d.tree.labels[d.tree.shapes[s].label];
    return text;
}

std::string after(const std::string& steps) {
    return equation(derived(std::string(figure1) + "derive part: " + steps + "\n", way("part")));
}

TEST(Figure1, StatesAreTheEquations) {
    EXPECT_EQ(after("R0"), "I0 ∪ A");                      // eq. 2
    EXPECT_EQ(after("R0 => R1"), "I0 ∪ B");                // eq. 3
    EXPECT_EQ(after("R0 => R2"), "I0 ∪ A ∪ DE");           // eq. 4
    EXPECT_EQ(after("R0 => R1 => R3"), "I0 ∪ B ∪ C");      // eqs. 5, 7
    EXPECT_EQ(after("R0 => R2 => R4"), "I0 ∪ A ∪ F ∪ G");  // eqs. 6, 8
}

TEST(Figure1, LeftWay) {
    const auto d = derived(figure1, way("left"));
    EXPECT_EQ(d.classic, 3u);
    EXPECT_EQ(d.morphic, 0u);
    ASSERT_EQ(d.steps.size(), 3u);
    EXPECT_EQ(d.grammar->rules[d.steps[2].rule].name, "R3");
    expectNear(at(d, "Figure/I0/A/B").scope.centre, {1, 0, 0});
    expectNear(at(d, "Figure/I0/A/B/C").scope.centre, {1, 1, 0});
    EXPECT_EQ(d.tree.bonds().all.size(), 2u);
    // B took A's place and with it A's bond: its -x is no longer free.
    EXPECT_TRUE(d.tree.bonds().closed(d.tree.find("Figure/I0/A/B"), 1));
}

TEST(Figure1, RightWay) {
    const auto d = derived(figure1, way("right"));
    EXPECT_EQ(d.classic, 2u);
    EXPECT_EQ(d.morphic, 1u);
    expectNear(at(d, "Figure/I0/A/DE/F").scope.centre, {1, 1, 0});
    EXPECT_EQ(d.tree.solidOf(d.tree.find("Figure/I0/A/DE")), nullptr);
    EXPECT_NE(derive::toText(d, true).find("R_M R2"), std::string::npos);
    EXPECT_NE(derive::toJson(d).find("\"+y\""), std::string::npos);
}

TEST(Figure1, WaysThatDontFitAreErrors) {
    const std::string text(figure1);
    const auto wrong = tryDerive(text + "derive part: R0 => R3\n", way("part"));
    ASSERT_FALSE(wrong.ok());
    EXPECT_NE(wrong.error().message.find("R3"), std::string::npos);
    EXPECT_EQ(wrong.error().message.rfind("test.sgm:10:", 0), 0u) << wrong.error().message;
    EXPECT_FALSE(tryDerive(text, way("nowhere")).ok());
}

TEST(Ways, APlaceChoosesAmongSeveral) {
    const std::string text = "grammar 1\nstart S -> cube : A, cube move (4, 0, 0) : A\nrule R: A -> sphere\n";
    const auto d = derived(text + "derive w: R at S/A[2]\n", way("w"));
    EXPECT_EQ(d.tree.labels[at(d, "S/A[2]/sphere").label], "sphere");
    EXPECT_NE(at(d, "S/A").solid, derive::none);
    EXPECT_FALSE(tryDerive(text + "derive w: R\n", way("w")).ok());
}

}  // namespace
}  // namespace sgm
