// What builders say: cutting a shape further up, materials apart from solids, values by name, shares with lengths,
// beams, copies, and draws that don't repeat.
#include <algorithm>
#include <set>

#include "grammar/derive/incremental_derivation.h"
#include "tests/derive/same.h"

namespace sgm {
namespace {

using namespace testing_;
using derive::Derivation;
using derive::ShapeId;

std::vector<ShapeId> shapesOf(const Derivation& d, std::string_view label) {
    std::vector<ShapeId> found;
    for (ShapeId s = 0; s != derive::none; s = d.tree.next(s))
        if (d.tree.labels[d.tree.shapes[s].label] == label) found.push_back(s);
    return found;
}

/// Solids in tree order.
std::vector<ShapeId> solidsOf(const Derivation& d) {
    std::vector<ShapeId> found;
    for (ShapeId s = 0; s != derive::none; s = d.tree.next(s))
        if (d.tree.shapes[s].solid != derive::none) found.push_back(s);
    return found;
}

std::string materialOf(const Derivation& d, ShapeId id) {
    const uint32_t material = d.tree.shapes[id].material;
    return material == derive::none ? "" : d.materials[material].name;
}

std::string failure(const std::string& text) {
    const auto d = tryDerive(text);
    return d.ok() ? "" : d.error().message;
}

constexpr const char* wall = R"(
start House -> cube size (8, 6, .6) : Mass
rule Mass -> + Front size (100%, 100%, 30cm) at +z to centre
rule Front -> split x { 1m: nil | { ~2m: Window }* | 1m: nil }
rule Window -> - cube size (1m, 1.6m, 2m) through Mass + cube size (1m, 1.6m, 4cm)
)";

TEST(Through, CutsTheHostBeforeThePartAndLeavesThePartWhole) {
    const auto d = derived(std::string("grammar 1") + wall);
    const ShapeId mass = d.tree.find("House/Mass");
    ASSERT_NE(mass, derive::none);
    std::vector<std::string> children;
    for (ShapeId c = d.tree.shapes[mass].firstChild; c != derive::none; c = d.tree.shapes[c].nextSibling)
        children.push_back(d.tree.labels[d.tree.shapes[c].label]);
    EXPECT_EQ(children, (std::vector<std::string>{"cube", "cube", "cube", "Front"}));
    EXPECT_EQ(derive::uncut(d).all().size(), 0u);
    const auto solids = solidsOf(d);
    std::set<double> places;
    for (size_t i = 1; i <= 3; ++i) places.insert(std::round(d.tree.shapes[solids[i]].scope.centre.x * 1e6) / 1e6);
    EXPECT_EQ(places, (std::set<double>{-2, 0, 2}));
    EXPECT_EQ(d.tree.shapes[solids[1]].op, rules::Operator::Difference);
}

TEST(Through, AShapeThatIsReplacedIsCutInWhatItBeginsWith) {
    const auto d = derived(R"(grammar 1
start House -> size (8, 6, 4) split y { 4m: Mass | ~1: nil }
rule Mass -> cube - cube size 80% + Front size (100%, 100%, 30cm) at +z to centre
rule Front -> split x { ~1: - cube size (1m, 1m, 9m) through Mass + cube size .1 | ~1: nil })");
    EXPECT_EQ(derive::uncut(d).all().size(), 0u);
    std::vector<rules::Operator> operators;
    const ShapeId content = d.tree.shapes[d.tree.find("House/split/Mass")].firstChild;
    for (ShapeId c = d.tree.shapes[content].firstChild; c != derive::none; c = d.tree.shapes[c].nextSibling)
        operators.push_back(d.tree.shapes[c].op);
    using rules::Operator;
    EXPECT_EQ(operators, (std::vector<Operator>{Operator::Difference, Operator::Difference, Operator::Sum}));
}

TEST(Through, PartsBeforeItInTheSameContentAreCutToo) {
    const auto d = derived(R"(grammar 1
start A -> size (8, 6, 4) Mass
rule Mass -> cube size (100%, 1m, 100%), cube + Front
rule Front -> - cube size (1m, 9m, 1m) through Mass)");
    const auto cuts = solidsOf(d);
    EXPECT_EQ(std::count_if(cuts.begin(), cuts.end(),
                            [&](ShapeId s) { return d.tree.shapes[s].op == rules::Operator::Difference; }),
              2);
}

TEST(Through, NeedsTheShapeAbove) {
    EXPECT_NE(failure("grammar 1\nstart A -> cube : B\nrule B -> + C\nrule C -> - cube through D\nrule D -> cube\n")
                  .find("no 'D' stands above this shape, so it can't cut one"),
              std::string::npos);
}

TEST(Through, GoesWithTheShapeThatCameFrom) {
    // B's content is replaced after the cutter was put into the wall: the cutter goes too.
    const auto d = derived(R"(grammar 1
start A -> cube size 9 : Wall
rule Wall -> + Part : B
rule Part -> - cube size 1 through Wall
rule B when count(Part) > 0 -> sphere)");
    for (const ShapeId s : solidsOf(d)) EXPECT_NE(d.tree.shapes[s].op, rules::Operator::Difference);
    EXPECT_EQ(shapesOf(d, "sphere").size(), 1u);
}

TEST(Through, FollowsASliderInPlace) {
    const std::string text =
        "grammar 1\nparam w = 1m in .5m..1.5m\n"
        "start House -> cube size (8, 6, .6) : Mass\n"
        "rule Mass -> + Front size (100%, 100%, 30cm) at +z to centre\n"
        "rule Front -> split x { { ~2m: Window }* }\n"
        "rule Window -> - cube size (w, 1.6m, 2m) through Mass + cube size (w, 1.6m, 4cm)\n";
    const auto grammar = grammarOf(text);
    derive::IncrementalDerivation incremental;
    derive::Options options;
    options.params = {rules::Value::number(1, rules::Unit::Metre)};
    ASSERT_TRUE(incremental.to(grammar, options, nullptr).ok());
    options.params = {rules::Value::number(1.25, rules::Unit::Metre)};
    ASSERT_TRUE(incremental.to(grammar, options, nullptr).ok());
    EXPECT_FALSE(incremental.whole());
    const auto whole = derive::derive(grammar, options, nullptr);
    ASSERT_TRUE(whole.ok());
    expectSame(incremental.derivation(), *whole);
}

TEST(Material, IsWornByAnySolidAndHandedDown) {
    const auto d = derived(R"(grammar 1
material stone color #c2b59b rough .9
terminal brick color #96533f
start A -> cylinder of stone + Tower of brick + sphere of brick rough .2
rule Tower -> cube + cone of stone)");
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 4u);
    EXPECT_EQ(materialOf(d, solids[0]), "stone");
    EXPECT_EQ(materialOf(d, solids[1]), "");  // the tower's own, which it inherits
    EXPECT_EQ(materialOf(d, solids[2]), "stone");
    EXPECT_EQ(materialOf(d, shapesOf(d, "Tower")[0]), "brick");
    EXPECT_EQ(d.materials[d.tree.shapes[solids[3]].material].color,
              d.materials[d.tree.shapes[shapesOf(d, "Tower")[0]].material].color);
    EXPECT_FLOAT_EQ(d.materials[d.tree.shapes[solids[3]].material].roughness, .2f);
}

TEST(Material, IsAValueThatChanceAndParametersGive) {
    const std::string text = R"(grammar 1
param skin = brick of brick, plaster
param paint = #ff0000
material brick color #96533f
material plaster color paint
material dark of brick rough .1
start A -> B with wall = choose { 1: plaster | 0: brick }, cube of skin, cube of dark
rule B -> cube of wall)";
    const auto d = derived(text);
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 3u);
    EXPECT_NEAR(d.materials[d.tree.shapes[solids[0]].material].color.x, 1, 1e-6);
    EXPECT_EQ(materialOf(d, solids[1]), "brick");
    EXPECT_EQ(materialOf(d, solids[2]), "dark");
    EXPECT_EQ(d.materials[d.tree.shapes[solids[2]].material].color,
              d.materials[d.tree.shapes[solids[1]].material].color);
    EXPECT_NE(failure("grammar 1\nmaterial m rough 1\nstart A -> B with wall = 3\nrule B -> cube of wall\n")
                  .find("'wall' is 3, and no material"),
              std::string::npos);
}

TEST(Let, NamesAValueOfTheFileOrOfABody) {
    const auto d = derived(R"(grammar 1
param n = 2 in 1..4
let storey = 3m
let high = n * storey
start A -> let w = (high / 2) cube size (w, high, storey), B
rule B -> let w = 1m..2m let k = 1..3 + cube size w + cube size w move (k, 0, 0))");
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 3u);
    expectNear(d.tree.shapes[solids[0]].scope.size, {3, 6, 3});
    EXPECT_EQ(d.tree.shapes[solids[1]].scope.size, d.tree.shapes[solids[2]].scope.size);  // drawn once
    EXPECT_GT(d.tree.shapes[solids[1]].scope.size.x, 1);
    const double k = d.tree.shapes[solids[2]].scope.centre.x - d.tree.shapes[solids[1]].scope.centre.x;
    EXPECT_NEAR(k, std::round(k), 1e-9);
}

TEST(MixedSizes, WhatAShapeAboveSetsIsALengthOrAShare) {
    const auto d = derived(R"(grammar 2
start A -> size (10, 8, 6) B with w = 2m, size (10, 8, 6) B with w = 25%, size (10, 8, 6) B with w = 2
rule B -> cube size (100% - w, w + 50%, 1m))");
    const auto solids = solidsOf(d);
    expectNear(d.tree.shapes[solids[0]].scope.size, {8, 6, 1});
    expectNear(d.tree.shapes[solids[1]].scope.size, {7.5, 6, 1});
    expectNear(d.tree.shapes[solids[2]].scope.size, {8, 6, 1});
}

TEST(MixedSizes, SharesMeetLengthsAlongTheirAxis) {
    const auto d = derived(R"(grammar 1
let rim = .5m
start A -> size (10, 6, 4) B
rule B -> cube size (100% - 1m, 50% + rim, max(10%, 3m)) move (0, -50% + 1m, 0), cube size (100% - 1m),
          Row size (10, 6, 4)
rule Row -> split x { 50% - 1m: cube | ~1: nil })");
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 3u);
    expectNear(d.tree.shapes[solids[0]].scope.size, {9, 3.5, 3});
    EXPECT_NEAR(d.tree.shapes[solids[0]].scope.centre.y, -2, 1e-9);
    expectNear(d.tree.shapes[solids[1]].scope.size, {9, 5, 3});
    EXPECT_NEAR(d.tree.shapes[solids[2]].scope.size.x, 4, 1e-9);
}

TEST(Beam, SpansFromPointToPointAndBetweenJoints) {
    const auto d = derived(R"(grammar 1
terminal post = cube joint eye at (0, .5, .5) facing +z
start A -> post size (2, 4, 2) + cylinder from (-1m, 0, 0) to (3m, 3m, 0) size .2m
                              + cube size (.1m, 9m, .1m) from -y to eye)");
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 3u);
    const derive::Scope& beam = d.tree.shapes[solids[1]].scope;
    expectNear(beam.centre, {1, 1.5, 0});
    expectNear(beam.size, {.2, 5, .2});
    expectNear(beam.axes * Vec3d{0, 1, 0}, {.8, .6, 0});
    const derive::Scope& strut = d.tree.shapes[solids[2]].scope;
    expectNear(strut.point({0, -1, 0}), {0, -2, 0});
    expectNear(strut.point({0, 1, 0}), {0, 2, 1});
    EXPECT_NE(failure("grammar 1\nparam h = 0m in 0m..1m\nstart A -> cube + cube from (0, 0, 0) to (0, h, 0) size .1\n")
                  .find("both ends of 'from … to …' are at one point"),
              std::string::npos);
}

TEST(Copies, AroundARowAndAMirror) {
    const auto d = derived(R"(grammar 1
start A -> cube size (10, 1, 6) + around 4 radius 3m { cube size (1m, 1m, i * .1m) }
start B -> size (10, 1, 6) row 3 along x gap 50cm { cube }
start C -> size (10, 1, 6) mirror x { cube size (1m, 1m, 1m) move (3m, 0, 1m) turn 30deg })");
    auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 5u);
    expectNear(d.tree.shapes[solids[1]].scope.centre, {0, 0, 3});
    expectNear(d.tree.shapes[solids[2]].scope.centre, {3, 0, 0});
    expectNear(d.tree.shapes[solids[2]].scope.axes * Vec3d{0, 0, 1}, {1, 0, 0});
    EXPECT_NEAR(d.tree.shapes[solids[4]].scope.size.z, .4, 1e-12);

    derive::Options options;
    options.start = 1;
    const auto row = derive::derive(d.grammar, options, nullptr);
    ASSERT_TRUE(row.ok());
    solids = solidsOf(*row);
    ASSERT_EQ(solids.size(), 3u);
    EXPECT_NEAR(row->tree.shapes[solids[0]].scope.size.x, 3, 1e-12);
    EXPECT_NEAR(row->tree.shapes[solids[2]].scope.centre.x, 3.5, 1e-12);

    options.start = 2;
    const auto mirror = derive::derive(d.grammar, options, nullptr);
    ASSERT_TRUE(mirror.ok());
    solids = solidsOf(*mirror);
    ASSERT_EQ(solids.size(), 2u);
    const derive::Scope &a = mirror->tree.shapes[solids[0]].scope, &b = mirror->tree.shapes[solids[1]].scope;
    const auto mirrored = [](Vec3d v) { return Vec3d{-v.x, v.y, v.z}; };
    expectNear(b.centre, mirrored(a.centre));
    expectNear(b.point({.3, .2, .9}), mirrored(a.point({.3, .2, .9})));
    EXPECT_NE(failure("grammar 1\nstart A -> size 1 row 5 along x gap 1m { cube }\n").find("don't fit into 1m; write"),
              std::string::npos);
}

/// The alternatives that the parts of a row of `n` draw, by the height of their cubes.
std::vector<int> seriesOf(const std::string& choice, int n, uint64_t seed) {
    const auto d =
        derived("grammar 1\nstart A -> size (" + std::to_string(n) + ", 9, 1) split x { { 1m: B with h = " + choice +
                    " }* }\nrule B -> cube size (.5, h, .5)\n",
                withSeed(seed));
    std::vector<int> drawn;
    for (const ShapeId s : solidsOf(d)) drawn.push_back(static_cast<int>(std::lround(d.tree.shapes[s].scope.size.y)));
    return drawn;
}

TEST(Series, DistinctNeverRepeatsTheOneBefore) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const auto drawn = seriesOf("choose distinct { 5: 1 | 1: 2 | 1: 3 }", 40, seed);
        ASSERT_EQ(drawn.size(), 40u);
        EXPECT_EQ(std::adjacent_find(drawn.begin(), drawn.end()), drawn.end()) << seed;
        EXPECT_EQ(std::set<int>(drawn.begin(), drawn.end()).size(), 3u) << seed;
    }
    EXPECT_NE(seriesOf("choose distinct { 1: 1 | 1: 2 | 1: 3 }", 40, 1),
              seriesOf("choose distinct { 1: 1 | 1: 2 | 1: 3 }", 40, 2));
}

TEST(Series, ShuffledGivesEachOnceInEveryRound) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const auto drawn = seriesOf("choose shuffled { 1: 1 | 1: 2 | 9: 3 | 0: 4 }", 30, seed);
        ASSERT_EQ(drawn.size(), 30u);
        EXPECT_EQ(std::adjacent_find(drawn.begin(), drawn.end()), drawn.end()) << seed;
        for (size_t i = 0; i < drawn.size(); i += 3)
            EXPECT_EQ(std::set<int>(drawn.begin() + static_cast<long>(i), drawn.begin() + static_cast<long>(i) + 3),
                      (std::set<int>{1, 2, 3}));
    }
}

TEST(Series, OfBodiesAndAlongAChainAndALoop) {
    const auto d = derived(R"(grammar 1
start A -> cube : B
rule B repeat 9 -> + C size (1, choose distinct { 1: 1 | 1: 2 }, 1) at +y : B
rule C -> cube, D
rule D -> for k in -4..4 { choose distinct { 1: sphere size .1 | 1: cone size .1 } })");
    std::vector<double> heights;
    for (const ShapeId s : shapesOf(d, "B"))
        if (d.tree.shapes[s].op == rules::Operator::Sum) heights.push_back(d.tree.shapes[s].scope.size.y);
    ASSERT_EQ(heights.size(), 9u);
    for (size_t i = 1; i < heights.size(); ++i) EXPECT_NE(heights[i], heights[i - 1]);
    const ShapeId loop = shapesOf(d, "D").front();
    std::vector<uint32_t> labels;
    for (ShapeId c = d.tree.shapes[loop].firstChild; c != derive::none; c = d.tree.shapes[c].nextSibling)
        labels.push_back(d.tree.shapes[c].label);
    ASSERT_EQ(labels.size(), 9u);
    for (size_t i = 1; i < labels.size(); ++i) EXPECT_NE(labels[i], labels[i - 1]) << i;
}

TEST(Grammar2, DivisionByZeroIsALocatedError) {
    const std::string rest = "\nparam n = 0 in 0..4\nstart A -> cube size 2 move (4 / n, 0, 0)\n";
    EXPECT_EQ(failure("grammar 1" + rest), "");
    EXPECT_NE(failure("grammar 2" + rest).find("test.sgm:3:30: divided by 0: 'n' is 0"), std::string::npos)
        << failure("grammar 2" + rest);
}

TEST(Grammar2, ANeighbourWinsOverPlainRules) {
    const std::string rest = R"(
start A -> Door + Wall at +x + Wall at -x
rule Door -> cube size 1
rule Wall -> sphere size 1
rule Wall beside Door -> cone size 1
)";
    for (uint64_t seed = 1; seed < 12; ++seed)
        EXPECT_EQ(shapesOf(derived("grammar 2" + rest, withSeed(seed)), "cone").size(), 2u) << seed;
    size_t cones = 0;
    for (uint64_t seed = 1; seed < 12; ++seed)
        cones += shapesOf(derived("grammar 1" + rest, withSeed(seed)), "cone").size();
    EXPECT_LT(cones, 22u);
}

TEST(Grammar2, SharesAndPlacesAreOfTheMatchedScope) {
    const std::string rest =
        "\nstart A -> size (4, 4, 4) B\nrule B -> cube size 1m move (1m, 0, 0) + sphere size 50%\n";
    const auto old = derived("grammar 1" + rest), now = derived("grammar 2" + rest);
    expectNear(old.tree.shapes[solidsOf(old)[1]].scope.centre, {1, 0, 0});
    EXPECT_NEAR(old.tree.shapes[solidsOf(old)[1]].scope.size.x, .5, 1e-12);
    expectNear(now.tree.shapes[solidsOf(now)[1]].scope.centre, {0, 0, 0});
    EXPECT_NEAR(now.tree.shapes[solidsOf(now)[1]].scope.size.x, 2, 1e-12);
}

TEST(Units, AreasAndVolumesAreCounted) {
    const auto d = derived(R"(grammar 2
param plot = 24m² in 10m2..90m2
start A -> size (plot / 6m, sqrt(9m²), 8m³ / 4m2) cube
check A expect count(A) == 1)");
    expectNear(d.tree.shapes[solidsOf(d)[0]].scope.size, {4, 3, 2});
}

TEST(Grammar2, TurnsAddUpAndSharesBehindATurnFollowIt) {
    const auto d = derived(R"(grammar 2
start A -> size (4, 6, 8) B
rule B -> cylinder turn (90deg, 0deg, 0deg) size (100%, 1m, 100%), cube turn 30deg turn (0deg, 0deg, 90deg) size 1m,
          prism turn 90deg size (100% + 1m, 1m, scope.x - 1m))");
    const auto solids = solidsOf(d);
    ASSERT_EQ(solids.size(), 3u);
    expectNear(d.tree.shapes[solids[2]].scope.size, {9, 1, 3});
    expectNear(d.tree.shapes[solids[0]].scope.size, {4, 1, 6});  // its z lies along -y
    const Mat3 expected = Mat3::rotation({0, 1, 0}, M_PI / 6) * Mat3::rotation({0, 0, 1}, M_PI / 2);
    expectNear(d.tree.shapes[solids[1]].scope.axes.x, expected.x);
    expectNear(d.tree.shapes[solids[1]].scope.axes.y, expected.y);
}

}  // namespace
}  // namespace sgm
