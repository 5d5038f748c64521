// Joints and bonds, SG-M eqs. 15–16.
#include "grammar/pipeline/checks.h"
#include "modeler/core/random.h"
#include "tests/cpu_time.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

/// Eq. 16 for every bond; where the grammar moves no mating point, the shift is zero too.
void expectEquation16(const derive::Derivation& d, bool unmoved) {
    for (const derive::Bond& b : d.tree.bonds().all) {
        const auto p = d.tree.joint(b.shape[0], b.joint[0]), q = d.tree.joint(b.shape[1], b.joint[1]);
        expectNear(p.point + b.shift, q.point, 1e-6);
        EXPECT_TRUE(!unmoved || length(b.shift) < 1e-6);
        EXPECT_EQ(b.directed, p.direction != Vec3d{} && q.direction != Vec3d{});
        if (b.directed) {
            expectNear(p.direction, -q.direction, 1e-6);
        }
    }
}

/// A chain of boxes at random joints, turned and sized at random.
std::string randomGrammar(uint64_t seed) {
    const char* joints[] = {"free()",       "free(+x, -z, +y)", "+y",
                            "free() to +x", "free() to centre", "free(+z, -z, -x) to -y"};
    const char* turns[] = {"", " turn 90deg", " turn 0deg..360deg", " turn (10deg, 20deg, 30deg)"};
    return "grammar 1\nstart S -> cube : A\nrule A repeat 20 -> + cube size (.5 .. 2, .5 .. 2, .5 .. 2) at " +
           std::string(joints[pick(seed, 6)]) + turns[pick(mix(seed), 4)] + " : A\n";
}

TEST(Joints, EveryBondObeysEquation16) {
    size_t bonds = 0;
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        const auto d = derived(randomGrammar(seed), withSeed(seed));
        bonds += d.tree.bonds().all.size();
        expectEquation16(d, true);
    }
    EXPECT_GT(bonds, 1000u);
    expectEquation16(derived(cave), false);
    expectEquation16(derived(cloud), false);
    expectEquation16(derived(house), true);
}

TEST(Joints, FaceToFaceByDefault) {
    const auto d = derived("grammar 1\nstart S -> cube size (2, 2, 2) + sphere size (1, 3, 1) at +y\n");
    expectNear(at(d, "S/cube/sphere").scope.centre, {0, 2.5, 0});
    EXPECT_EQ(d.tree.bonds().all[0].joint[1], 3u);
}

TEST(Joints, LastIsWhatWasPlacedLastInAnyBody) {
    const auto d = derived("grammar 2\nstart S -> cube size 4 + cube size 2 at +y + sphere size 1 on last at +y\n");
    EXPECT_NEAR(d.tree.shapes[static_cast<derive::ShapeId>(d.tree.shapes.size() - 1)].scope.centre.y, 2 + 2 + .5, 1e-9);
}

TEST(Joints, CentreOverlapAndShift) {
    const auto centre =
        derived("grammar 1\nstart S -> cube size 2 + sphere size 1 at +x to centre shift (0, .5, .25m)\n");
    expectNear(at(centre, "S/cube/sphere").scope.centre,
               {1, 0.25, 0.25});  // half of the half-size; a quarter of a metre
    const auto overlap = derived("grammar 1\nstart S -> cube size 2 + sphere size 1 at +x overlap 1\n");
    expectNear(at(overlap, "S/cube/sphere").scope.centre, {1, 0, 0});
    const auto alone = derived("grammar 1\nstart S -> cube size 2 + sphere size 50% move (0, 3, 0)\n");
    expectNear(at(alone, "S/cube/sphere").scope.centre, {0, 3, 0});
    expectNear(at(alone, "S/cube/sphere").scope.size, {1, 1, 1});
}

TEST(Joints, NewcomerIsTurnedUntilDirectionsOppose) {
    const auto d = derived(
        "grammar 1\nterminal gate = cube joint door at (.5, 0, 0) facing -z\nstart S -> cube size 2 + gate size (1, 1, "
        "3) at +x to door\n");
    const auto& gate = at(d, "S/cube/gate");
    expectNear(gate.scope.axes * Vec3d{0, 0, -1}, {-1, 0, 0});
    expectEquation16(d, true);
}

TEST(Joints, ABondClosesFacesButNotCentres) {
    // The second box finds +y taken; spheres on a joint's point leave it open.
    EXPECT_EQ(derived("grammar 1\nstart S -> cube + cube at +y + cone at +y\n").tree.bonds().all.size(), 1u);
    EXPECT_EQ(
        derived("grammar 1\nstart S -> cube + sphere at +y to centre + cone at +y to centre\n").tree.bonds().all.size(),
        2u);
}

TEST(Joints, CoincidingFacesAreBonded) {
    // Four boxes around a square: the last one also meets the first.
    const auto d = derived(R"(grammar 1
start S -> cube : A
rule A -> + cube at +x : B
rule B -> + cube at +z : C
rule C -> + cube at -x : D
rule D -> + sphere at free(-z, +z)
)");
    EXPECT_EQ(d.tree.bonds().all.size(), 5u);
    expectNear(at(d, "S/A/B/C/D/sphere").scope.centre, {0, 0, 2});  // -z looks at A, so only +z is free
    expectEquation16(d, true);
}

TEST(Joints, WithoutAFreeJointTheRuleDoesntMatch) {
    const auto d =
        derived("grammar 1\nstart S -> cube : A\nrule A -> + cube at +x : B\nrule B -> + cube at free(-x)\n");
    EXPECT_EQ(d.steps.size(), 1u);
    EXPECT_TRUE(at(d, "S/A/B").live);
}

TEST(Joints, BesideAsksForANeighbour) {
    const auto d = derived(
        "grammar 1\nstart S -> cube : A\nrule A -> + cube at +x : B, + cube at -x to centre : C\nrule B beside A -> "
        "sphere\nrule C beside B -> sphere\n");
    EXPECT_NE(d.tree.find("S/A/B/sphere"), derive::none);
    EXPECT_EQ(at(d, "S/A/C").firstChild, derive::none);
}

TEST(Figures, OverlapsAndFloating) {
    const auto d =
        derived("grammar 1\nstart S -> cube, cube move (.5, 0, 0), cube move (5, 3, 0), cube move (1.5, 0, 0)\n");
    EXPECT_EQ(d.overlaps(), 1u);
    EXPECT_EQ(d.floating(), 1u);
    EXPECT_EQ(d.terminals(), 4u);
    EXPECT_EQ(derived(house).overlaps(), 0u);
}

TEST(Figures, ChecksRun) {
    pipeline::Context context;
    const auto verdicts = pipeline::runChecks(
        grammarOf(std::string(house) + "check House { floors = 2 } expect bonds == 7\n"), 1, context);
    ASSERT_TRUE(verdicts.ok());
    ASSERT_EQ(verdicts->size(), 2u);
    EXPECT_TRUE((*verdicts)[0].passed) << (*verdicts)[0].message;
    EXPECT_FALSE((*verdicts)[1].passed);
    EXPECT_NE((*verdicts)[1].message.find("bonds is 2"), std::string::npos);
}

TEST(Bonds, NothingMeetsTheBoxWhereTheStartBegins) {
    // The ball's lower joint touches the unit box of the start, in which nothing stands.
    const auto d = derived("grammar 1\nstart S -> cone size 2 + sphere size 1 at apex to centre\n");
    EXPECT_EQ(d.tree.bonds().all.size(), 1u);
    // The first solid's own joints still meet, when it fills that box exactly too.
    const auto met = derived("grammar 1\nstart S -> cube size 1, cube size 1 move (1, 0, 0)\n");
    EXPECT_EQ(met.tree.bonds().all.size(), 1u);
}

TEST(Bonds, AClosedJointIsCountedWhereNothingGrew) {
    const auto d =
        derived("grammar 1\nstart S -> cube : A\nrule A -> + cube at +x + cube at +x for k in 1..3 { + cube at +x }\n");
    EXPECT_EQ(d.terminals(), 2u);
    ASSERT_EQ(d.closed.size(), 2u);
    EXPECT_EQ(d.closed[0].count, 1u);
    EXPECT_EQ(d.closed[0].span.text(), "+ cube at +x");
    EXPECT_EQ(d.closed[1].count, 3u);
    const std::string text = derive::toText(d, true);
    EXPECT_NE(text.find("test.sgm:3:24: its joint was closed once, so nothing grew there: '+x' of 'S/A' is closed by "
                        "'S/A/cube', made by rule 'A#1' (test.sgm:3)\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("closed 3 times, so nothing grew there: first '+x' of 'S/A'"), std::string::npos) << text;
    EXPECT_NE(derive::toJson(d).find("\"by\": \"'+x' of 'S/A' is closed by"), std::string::npos);
}

TEST(OnEach, GrowsOnEveryShapeOfTheName) {
    const auto d = derived(R"(grammar 1
start Row -> cube size 2 with n = 0 : Cell
rule Cell repeat 4 -> + cube size 2 at +x with n = i : Cell
  finally - Hole on each(Cell) with n = n move (0, 1, 0)
rule Hole -> sphere size (1 + n)
)");
    std::vector<Vec3d> places;
    for (const auto& s : d.tree.shapes)
        if (s.op == rules::Operator::Difference) places.push_back(s.scope.centre);
    ASSERT_EQ(places.size(), 5u);
    for (size_t k = 0; k < 5; ++k) expectNear(places[k], {2.0 * static_cast<double>(k), 1, 0});
    // A value passed on is the host's.
    std::vector<double> sizes;
    for (const auto& s : d.tree.shapes)
        if (s.solid != derive::none && s.parent != derive::none && d.tree.labels[s.label] == "sphere")
            sizes.push_back(s.scope.size.x);
    std::sort(sizes.begin(), sizes.end());
    EXPECT_EQ(sizes, (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(Joints, ShapesThatAllStandAtOnePlaceTakeNoLongerThanOthers) {
    std::string crowd = "grammar 1\nstart S -> cube size 1";
    for (int i = 0; i < 40'000; ++i) crowd += " + cube size 1";
    const double begin = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    const auto d = derived(crowd + " + cube size 1 move (1m, 0m, 0m)\n");
    EXPECT_LT(secondsOf(CLOCK_PROCESS_CPUTIME_ID) - begin, boundSeconds(4)) << "quadratic work takes ten seconds";
    EXPECT_EQ(d.overlaps(), 1'000'000u) << "of 800 million; counting has an end";
    // The newest of the crowd meets the one beside it.
    const auto last = static_cast<derive::ShapeId>(d.tree.shapes.size() - 1);
    size_t met = 0;
    for (const derive::Bond& b : d.tree.bonds().all)
        if (b.directed && (b.shape[0] == last || b.shape[1] == last))
            met += b.shape[0] == last - 1 || b.shape[1] == last - 1;
    EXPECT_EQ(met, 1u);
}

TEST(OnEach, NothingOfTheNameIsNoError) {
    const auto d = derived("grammar 1\nstart S -> cube - sphere on each(Knob)\nrule Knob -> cube\nstart T -> Knob\n");
    EXPECT_EQ(d.terminals(), 1u);
}

}  // namespace
}  // namespace sgm
