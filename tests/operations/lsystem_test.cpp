// L-systems that draw plans.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>

#include "grammar/derive/lsystem.h"
#include "tests/derive/grammars.h"
#include "tests/operations/shapes_called.h"

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
        return text.ok() ? text->text : text.error().message;
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

TEST(Lsystems, BodiesRunAlongStepsWithoutWallsToo) {
    const derive::Derivation d = derived(
        "grammar 2\nlsystem P passes 0 step 2m\n  axiom \"FfF\"\nterminal post = cube\nterminal gap = cube\n"
        "start A -> size (1, 1, 1) turtle P { F: post | f: gap }\n");
    EXPECT_EQ(shapesCalled(d, "post").size(), 2u);
    const auto gaps = shapesCalled(d, "gap");
    ASSERT_EQ(gaps.size(), 1u);
    EXPECT_NEAR(gaps[0].scope.centre.x, 3, 1e-9);
    EXPECT_NEAR(gaps[0].scope.size.x, 2, 1e-9);
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

TEST(Lsystems, LettersHaveNumbersAndConditions) {
    // ABOP, figure 1.39: (a) of the parametric system with its letters alone.
    const std::string text =
        "lsystem Abop passes 2\n  axiom \"B(2) A(4, 4)\"\n  A(x, y) -> \"A(x * 2, x + y)\" when y <= 3\n"
        "  A(x, y) -> \"B(x) A(x / y, 0)\" when y > 3\n  B(x) -> \"C\" when x < 1\n  B(x) -> \"B(x - 1)\" when x >= 1";
    const Grown grown(text);
    const auto letters = derive::rewritten(grown.lsystem(), grown.place);
    ASSERT_TRUE(letters.ok()) << letters.error().message;
    EXPECT_EQ(letters->text, "BBA");
    const std::vector<double> expected{0, 3, 2, 1};
    EXPECT_EQ(letters->numbers, expected);
}

TEST(Lsystems, NumbersMayAskParameters) {
    const Grown grown(
        "param r = .5 in .1..0.9\nlsystem P passes 3\n  axiom \"F(8m)\"\n  F(l) -> \"F(l * r)\" when l > 1.5");
    const auto letters = derive::rewritten(grown.lsystem(), grown.place);
    ASSERT_TRUE(letters.ok());
    EXPECT_EQ(letters->numbers, std::vector<double>{1});
}

TEST(Lsystems, ASignalRunsThroughItsNeighbours) {
    // ABOP, section 1.8: B is passed on from letter to letter, past branches and turns.
    const std::string text = "axiom \"BA+A[-A]A\"\n  B < A -> \"B\"\n  B -> \"A\"";
    EXPECT_EQ(Grown("lsystem S passes 1\n  " + text).letters(), "AB+A[-A]A");
    EXPECT_EQ(Grown("lsystem S passes 2\n  " + text).letters(), "AA+B[-A]A");
    EXPECT_EQ(Grown("lsystem S passes 3\n  " + text).letters(), "AA+A[-B]B");
    EXPECT_EQ(Grown("lsystem S passes 1\n  axiom \"AA[B]AB\"\n  A > B -> \"C\"").letters(), "AA[B]CB");
}

TEST(Lsystems, BadLettersAreLocated) {
    const auto messageOf = [](const std::string& text) {
        const auto source =
            std::make_shared<const syntax::Source>("t.sgm", "grammar 1\n" + text + "\nstart A -> cube\n");
        syntax::Diagnostics diagnostics;
        rules::load(source, operations::table(), rules::Loader(), diagnostics);
        if (diagnostics.all().empty()) return std::string("nothing");
        const auto place = source->place(diagnostics.all()[0].span.begin);
        return std::to_string(place.line) + ":" + std::to_string(place.column) + " " + diagnostics.all()[0].message;
    };
    EXPECT_EQ(messageOf("lsystem P axiom \"F(2\""), "2:19 this '(' has no ')' behind it");
    EXPECT_EQ(messageOf("lsystem P axiom \"F(nope)\"").substr(0, 4), "2:20");
    EXPECT_NE(messageOf("lsystem P axiom \"F\" F(l) -> \"F(l + )\""), "nothing");
    EXPECT_NE(messageOf("lsystem P axiom \"+(3m)F\""), "nothing") << "a turn takes an angle";
}

TEST(Turtle, StepsInSpaceAreJoined) {
    const auto d = derived(
        "grammar 1\nterminal wall\nterminal leaf = sphere\nlsystem P passes 0 angle 90deg step 2m\n  axiom "
        "\"F+F&F^F[-F]L\"\n"
        "start S -> size (1, 3, .2m) turtle P { F: wall | L: leaf }\n");
    std::vector<derive::Shape> walls;
    std::optional<derive::Shape> leaf;
    for (const derive::Shape& s : d.tree.shapes) {
        const std::string label = d.tree.labels[s.label];
        if (label == "wall") walls.push_back(s);
        if (label == "leaf") leaf = s;
    }
    ASSERT_EQ(walls.size(), 5u);
    ASSERT_TRUE(leaf);
    for (const derive::Shape& s : walls) {
        expectNear(s.scope.size, {2, 3, .2});
        EXPECT_NEAR(dot(cross(s.scope.axes.x, s.scope.axes.y), s.scope.axes.z), 1, 1e-12);
    }
    expectNear(walls[0].scope.centre, {1, 0, 0});
    expectNear(walls[1].scope.centre, {2, 0, 1});  // left turns go from +x to +z, as in outlines
    expectNear(walls[2].scope.centre, {2, -1, 2});
    expectNear(walls[3].scope.centre, {2, -2, 3});
    expectNear(leaf->scope.centre, {2, -2, 4});
}

TEST(Turtle, ATreeRisesAndThins) {
    const auto d = derived(
        "grammar 1\nterminal wood = cylinder\nlsystem T passes 5\n  axiom \"A(2m, .4m)\"\n"
        "  A(l, w) -> \"!(w) F(l) [+(30deg) A(l * .8, w * .7)] [-(30deg) A(l * .8, w * .7)]\"\n"
        "start S -> turtle T upward { F: wood }\n");
    size_t count = 0;
    double least = 1, lowest = 9;
    for (const derive::Shape& s : d.tree.shapes) {
        if (d.tree.labels[s.label] != "wood") continue;
        ++count;
        least = std::min(least, s.scope.size.x);
        lowest = std::min(lowest, s.scope.centre.y - s.scope.size.y / 2);
    }
    EXPECT_EQ(count, 31u) << "2^5 - 1 segments";
    EXPECT_NEAR(least, .4 * std::pow(.7, 4), 1e-9);
    EXPECT_NEAR(lowest, -.5, 1e-9) << "it stands on the scope's foot";
}

TEST(Walls, StandAlongLettersAndPoints) {
    const auto areaOf = [](const std::string& plan) {
        const auto d = derived(
            "grammar 1\nterminal wall\nlsystem P passes 0 angle 90deg step 4m\n  axiom \"F+F+F\"\n"
            "start S -> footprint " +
            plan + " wall\n");
        for (const derive::Shape& s : d.tree.shapes)
            if (s.scope.footprint != derive::none)
                return area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
        return 0.0;
    };
    EXPECT_NEAR(areaOf("walls(P, .2m)"), 12 * .2, 1e-4);
    EXPECT_NEAR(areaOf("walls(.3m, (0, 0), (8, 0), (8, 6))"), 14 * .3, 1e-4);
    EXPECT_NEAR(areaOf("walls(.3m, (0, 0), (8, 0), (8, 6), (0, 6), (0, 0))"), 28 * .3, 1e-4) << "closed";
}

}  // namespace
}  // namespace sgm::testing_
