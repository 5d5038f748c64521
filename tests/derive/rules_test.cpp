// Rules: matching, choice, chains, budgets, and draws that stay put.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

TEST(Chains, CloudAddsNSpheresInTheNthRule) {
    const auto d = derived(cloud);
    // Σ over axes of 1 + … + Max, the root and the closing torus; and the start's own node.
    EXPECT_EQ(d.terminals(), 45u + 21 + 6 + 3 + 10 + 10 + 2);
    EXPECT_EQ(d.classic, 9u);
    EXPECT_EQ(d.morphic, 1u);
    EXPECT_EQ(d.steps[1].madeCount, 2u * 6);
    const auto& torus = at(d, "Cloud/Puff/torus");
    EXPECT_EQ(torus.op, rules::Operator::Morph);
    EXPECT_DOUBLE_EQ(torus.amount, 0.2);
    EXPECT_GT(torus.scope.size.x, 5);  // it fills the box of everything grown
}

TEST(Chains, CaveRunsOnTheNewestAndNeverTurnsBack) {
    const auto d = derived(cave);
    EXPECT_EQ(d.morphic, 14u);
    EXPECT_EQ(d.tree.bonds().all.size(), 14u);
    for (size_t i = 1; i < d.tree.bonds().all.size(); ++i) {
        EXPECT_EQ(d.tree.bonds().all[i].shape[0], d.tree.bonds().all[i - 1].shape[1]);
        const auto came = d.tree.bonds().all[i - 1].joint[0], went = d.tree.bonds().all[i].joint[0];
        EXPECT_NE(went, came ^ 1u);
    }
    expectNear(at(d, "Cave/Cell/Cell").scope.size, {2, 2, 2});
    expectNear(at(d, "Cave/Cell/Cell[14]").scope.size, {1.2, 1.2, 1.2});
}

TEST(Chains, MorphsGoFromFirstToLast) {
    const auto d = derived(
        "grammar 1\nstart S -> sphere : A\nrule A repeat 5 -> + morph(sphere, cube, 0 ~> 1) size 2 ~> 1 at +x : A\n");
    for (int i = 1; i <= 5; ++i) {
        const auto& shape = at(d, "S/A/A" + (i > 1 ? "[" + std::to_string(i) + "]" : ""));
        EXPECT_DOUBLE_EQ(d.tree.solids[shape.solid].amount, (i - 1) / 4.0);
        EXPECT_DOUBLE_EQ(shape.scope.size.x, 2 - (i - 1) / 4.0);
    }
    EXPECT_EQ(d.morphic, 5u);
}

TEST(Chains, HouseStacksStoreysAndPutsTheRoofOnTheLast) {
    const auto d = derived(house);
    EXPECT_EQ(d.tree.bonds().all.size(), 7u);
    expectNear(at(d, "House/Storey/Storey[6]").scope.size, {8, 2.8, 7});
    const auto& top = at(d, "House/Storey/Storey[6]").scope;
    const auto& roof = at(d, "House/Storey/roof").scope;
    EXPECT_NEAR(roof.centre.y, top.centre.y + 1.4 + 1.5, 1e-9);
    derive::Options convex;
    for (const auto& p : d.grammar->params) convex.params.push_back(p.value);
    convex.params[1].text = "convex";
    EXPECT_EQ(derived(house, convex).terminals(), 7u * 5 + 1);
}

/// A roof is a morph of pyramid and ellipsoid, but for its two ends.
TEST(Rules, ARoofBetweenItsEndsIsAMorphicRule) {
    for (const auto& [peak, morphic] : {std::pair("0", 0u), {"0.4", 1u}, {"1", 0u}, {".2..0.3", 1u}}) {
        const auto only =
            derived("grammar 1\nstart S -> cube : A\nrule A -> + roof(" + std::string(peak) + ") at +y\n");
        EXPECT_EQ(only.morphic, morphic) << peak;
        EXPECT_EQ(only.classic, 1u - morphic) << peak;
    }
}

TEST(Chains, AnyDrawsAmongTheStepBefore) {
    const auto d = derived(
        "grammar 1\nstart S -> cube : A\nrule A repeat 3 -> for k in 1..2 { + cube size .5 on any(+x) at +x to centre "
        ": A }\n");
    for (const derive::Bond& b : d.tree.bonds().all) {
        if (b.directed) continue;  // faces that happen to coincide
        const uint32_t step = d.steps[d.tree.shapes[b.shape[1]].madeBy].chainIndex;
        const uint32_t madeBy = d.tree.shapes[b.shape[0]].madeBy;
        EXPECT_EQ(madeBy == derive::none ? 0 : d.steps[madeBy].chainIndex, step - 1);
    }
}

TEST(Rules, GuardsWinInFileOrderAndWeightsDraw) {
    const std::string text =
        "grammar 1\nparam n = 1 in 0..9\nstart S -> for k in 1..400 { cube move (2 * k, 0, 0) : A }\nrule A when n > 1 "
        "-> sphere\nrule A when n > 0 -> cone\nrule A -> torus\nrule A weight 3 -> cylinder\n";
    const auto count = [&](double n, const char* label) {
        derive::Options options;
        options.params = {rules::Value::number(n)};
        const auto d = derived(text, options);
        size_t found = 0;
        for (const auto& s : d.tree.shapes) found += d.tree.labels[s.label] == label;
        return found;
    };
    EXPECT_EQ(count(2, "sphere"), 400u);
    EXPECT_EQ(count(1, "cone"), 400u);
    EXPECT_NEAR(static_cast<double>(count(0, "cylinder")), 300, 30);
    EXPECT_EQ(count(0, "torus") + count(0, "cylinder"), 400u);
}

TEST(Rules, ReplacingDropsGrowingKeeps) {
    const auto d = derived("grammar 1\nstart S -> Box : Wrap\nrule Box -> cube\nrule Wrap -> + sphere at +y\n");
    EXPECT_NE(d.tree.find("S/Wrap/Box/cube"), derive::none);
    EXPECT_NE(d.tree.find("S/Wrap/sphere"), derive::none);
    const auto gone = derived("grammar 1\nstart S -> Box : Wrap\nrule Box -> cube\nrule Wrap -> cone\n");
    EXPECT_EQ(gone.terminals(), 1u);
    EXPECT_EQ(derived("grammar 1\nstart S -> cube : A, cube move (2, 0, 0)\nrule A -> nil\n").terminals(), 1u);
}

TEST(Rules, CountReadsTheGenerationsStart) {
    const auto d = derived(
        "grammar 1\nstart S -> cube : A, cube move (3, 0, 0) : A\nrule A when count(B) < 1 -> cube : B\nrule B when "
        "count(B) > 2 -> cone\n");
    EXPECT_EQ(d.steps.size(), 2u);  // both saw no B
}

TEST(Rules, ValuesAreInherited) {
    const auto d = derived("grammar 1\nstart S -> A with tall = 3\nrule A -> B\nrule B -> cube size (1, tall, 1)\n");
    expectNear(at(d, "S/A/B/cube").scope.size, {1, 3, 1});
}

std::string sizesOf(const derive::Derivation& d, const std::string& under) {
    std::string text;
    const derive::ShapeId root = d.tree.find(under);
    for (derive::ShapeId s = root; s != derive::none; s = d.tree.next(s, root))
        text += std::to_string(d.tree.shapes[s].scope.size.x) + " ";
    return text;
}

TEST(Draws, EditingOneBranchLeavesTheOthersAlone) {
    const std::string rules = "rule Right -> cube size .2..1 + sphere size .2..1 at free()\n";
    const auto before =
        sizesOf(derived("grammar 1\nstart S -> Left, Right\nrule Left -> cube size .2..1\n" + rules), "S/Right");
    for (const char* edit : {"start S -> Right, Left\nrule Left -> cube size .2..1\n",
                             "start S -> cone, Left, Right\nrule Left -> sphere, sphere size .2..1\n",
                             "start S -> Port, Right\nrule Port -> cube size .2..1\n",
                             "start S -> Left, Right\nrule Other: Left -> for d in axes { sphere size .2..1 }\n"})
        EXPECT_EQ(sizesOf(derived("grammar 1\n" + std::string(edit) + rules), "S/Right"), before) << edit;
    EXPECT_NE(sizesOf(derived("grammar 1\nstart S -> Left, Right\nrule Left -> cube size .2..1\n" + rules, withSeed(2)),
                      "S/Right"),
              before);
}

TEST(Draws, ALoopsTurnsAreKeyedByTheirValue) {
    const auto size = [](const std::string& axes) {
        const auto d = derived("grammar 1\nstart S -> cube + cube size 3 : A\nrule A -> for d in (" + axes +
                               ") { + sphere size .2..1 at d }\n");
        for (const auto& b : d.tree.bonds().all)
            if (b.joint[0] == 5) return d.tree.shapes[b.shape[1]].scope.size.x;
        return 0.0;
    };
    EXPECT_GT(size("+x, -z"), 0.2);
    EXPECT_EQ(size("+x, -z"), size("+x, +y, -x, -z"));
}

TEST(Derive, SameSeedSameTree) {
    for (const char* text : {cave, cloud, house})
        EXPECT_EQ(derive::toJson(derived(text, withSeed(7))), derive::toJson(derived(text, withSeed(7))));
    EXPECT_NE(derive::toJson(derived(cave, withSeed(7))), derive::toJson(derived(cave, withSeed(8))));
}

const char* const runaway =
    "grammar 1\nparam stop = 0 in 0..1\nstart S -> cube : X\nrule Grow: X when stop < 1 -> + cube size 50% at +x : X, "
    "+ cube size 50% at +y : X\n";

TEST(Budgets, ShapesDepthMemorySecondsEndWithAPlace) {
    const auto expectBudget = [](const char* text, derive::Budget budget, const char* what) {
        derive::Options options = withSeed(42);
        options.budget = budget;
        const auto d = tryDerive(text, options);
        ASSERT_FALSE(d.ok());
        EXPECT_EQ(d.error().kind, Error::Kind::Budget);
        for (const char* part : {what, "rule 'Grow'", "seed 42", "test.sgm:4", "S/X"})
            EXPECT_NE(d.error().message.find(part), std::string::npos) << part << " in " << d.error().message;
    };
    expectBudget(runaway, {.shapes = 5000}, "5000 shapes");
    expectBudget(runaway, {.depth = 12}, "12 levels");
    expectBudget(runaway, {.memory_bytes = 1 << 20}, "1 MiB");
    expectBudget(runaway, {.seconds = 0}, "seconds");
    const char* loop =
        "grammar 1\nparam stop = 0 in 0..1\nstart S -> cube : X\nrule Grow: X -> cube while stop < 1 { when stop > 2 { "
        "+ cube } }\n";
    expectBudget(loop, {.shapes = 10000}, "no end");
}

TEST(Budgets, CancelEndsTheDerivation) {
    Progress progress;
    progress.cancel();
    const auto d = derive::derive(grammarOf(runaway), {}, &progress);
    ASSERT_FALSE(d.ok());
    EXPECT_EQ(d.error().kind, Error::Kind::Cancelled);
}

TEST(Budgets, DeepTreesDontRecurse) {
    const auto d = derived(
        "grammar 1\nstart S -> cube : X\nrule X when scope.x > .1 -> + cube size (scope.x - .0001, 1, 1) at +y : X\n");
    EXPECT_EQ(d.tree.shapes.back().depth, 9002u) << d.tree.shapes.size();
    EXPECT_LT(d.tree.path(static_cast<derive::ShapeId>(d.tree.shapes.size() - 1)).size(), 200u);
    EXPECT_GT(derive::toText(d, false).size(), 9000u);
}

/// What a rule says whose values `k` and `m` another shape sets by `with`.
std::string toldOfValues(const std::string& body, const std::string& values = "with k = 1 with m = 2") {
    const auto d = tryDerive("grammar 2\nstart S -> size (10, 4, 2) A " + values + "\nrule A " + body + "\n");
    return d.ok() ? "" : d.error().message.substr(0, d.error().message.find(" in rule"));
}

TEST(Values, UnitsThatDifferAreAnErrorWhereTheyAreKnown) {
    const auto d = tryDerive(
        "grammar 2\nstart S -> size (10, 4, 2) A with k = 1\n"
        "rule A -> let w = (100% - k * 3m) cube size (w, 100%, 100%)\n");
    ASSERT_FALSE(d.ok());
    EXPECT_EQ(d.error().kind, Error::Kind::Input);
    EXPECT_EQ(d.error().message,
              "test.sgm:3:20: can't subtract a share (%) and a length in rule 'A#1' at S/A, seed 1; they meet in "
              "'size', 'move' and the sizes of a 'split'; elsewhere write 'scope.x', 'scope.y' or 'scope.z' for 100%");
    EXPECT_EQ(toldOfValues("-> let w = max(50% - k * 3m, 1.2m) cube size (w, 1m, 1m)"),
              "test.sgm:3:23: can't subtract a share (%) and a length");
    EXPECT_EQ(toldOfValues("-> let w = max(k * 50%, 1.2m) cube size (w, 1m, 1m)"),
              "test.sgm:3:23: can't compare a share (%) and a length");
    EXPECT_EQ(toldOfValues("-> let w = (k + m) cube size (w, 1m, 1m)", "with k = 50% with m = 2m"),
              "test.sgm:3:20: can't add a share (%) and a length")
        << "neither is known before";
    EXPECT_EQ(toldOfValues("-> let w = clamp(.5, k, m) cube size (w, 1m, 1m)", "with k = 50% with m = 2m"),
              "test.sgm:3:29: can't compare a share (%) and a length")
        << "a plain number meets both";
    EXPECT_EQ(toldOfValues("-> let w = (k * 50%..3m) cube size (w, 1m, 1m)"),
              "test.sgm:3:20: can't draw between a share (%) and a length");
    EXPECT_EQ(toldOfValues("repeat 2 -> + cube size (k * 50% ~> 3m)"),
              "test.sgm:3:33: can't go between a share (%) and a length");
    EXPECT_EQ(toldOfValues("when k < 3m -> cube", "with k = 50%"),
              "test.sgm:3:13: can't compare a share (%) and a length");
    EXPECT_EQ(toldOfValues("-> let w = (k * 30deg + 1m) cube size (w, 1m, 1m)"),
              "test.sgm:3:20: can't add an angle and a length");
}

TEST(Values, UnitsThatMeetAreFineWhereTheyAreKnown) {
    EXPECT_EQ(toldOfValues("-> let w = (100% - k * 30%) cube size (w, 100%, 100%)"), "");
    EXPECT_EQ(toldOfValues("-> let w = (scope.x - k * 3m) cube size (w, 100%, 100%)"), "");
    EXPECT_EQ(toldOfValues("-> cube size (100% - k * 3m, 100%, 100%)"), "") << "the share is of the scope";
    EXPECT_EQ(toldOfValues("when k == 1 -> let w = (max(0, k * 3m) + k) cube size (w, 1m, 1m)"), "")
        << "a plain number meets all";
}

TEST(Values, ARadiusBelowZeroIsAnErrorWhereItIsKnown) {
    EXPECT_EQ(
        toldOfValues("-> around 3 radius k { cube size 1 }", "with k = -2m"),
        "test.sgm:3:27: 'radius' is -2m, but must be no less than 0: copies that look inward say 'turn 180deg' in "
        "their body");
    EXPECT_EQ(toldOfValues("-> around 3 radius k { cube size 1 }", "with k = 0m"), "");
}

TEST(Values, WhatNothingAboveSetsIsAnError) {
    const std::string text = "grammar 1\nstart S -> A with n = 2, A\nrule A -> cube size n\n";
    const auto d = tryDerive(text);
    ASSERT_FALSE(d.ok());
    EXPECT_EQ(d.error().kind, Error::Kind::Input);
    EXPECT_EQ(d.error().message,
              "test.sgm:3:21: neither this shape nor any above it sets 'n' by 'with' in rule 'A#1' at S/A[2], seed 1; "
              "set it where a "
              "shape above is made, or declare a 'param'");
    // A guard asks too, and says which rule it belongs to.
    const auto guarded =
        tryDerive("grammar 1\nstart S -> A with n = 2, B\nrule A -> cube size n\nrule B when n > 1 -> cube\n");
    ASSERT_FALSE(guarded.ok());
    EXPECT_NE(guarded.error().message.find(
                  "test.sgm:4:13: neither this shape nor any above it sets 'n' by 'with' in rule 'B#1' at S/B"),
              std::string::npos)
        << guarded.error().message;
    EXPECT_TRUE(tryDerive("grammar 1\nstart S -> A with n = 2\nrule A -> B : C\nrule B -> cube size n\n").ok());
}

TEST(Values, AnInheritedVectorIsIndexed) {
    const auto d = tryDerive("grammar 1\nstart S -> A with n = (4, 5, 6)\nrule A -> cube size (n[2], n[0] + 0, 1)\n");
    ASSERT_TRUE(d.ok()) << d.error().message;
    EXPECT_EQ(d->tree.shapes.back().scope.size, (Vec3d{6, 4, 1}));
}

TEST(Ways, AFailingStepNamesItsOwnRule) {
    derive::Options options = way("w");
    const auto d = tryDerive(
        "grammar 1\nstart S -> cube : A\nrule R0: A -> + cube at +x : B, + cube at -x : B\nrule R1: B -> "
        "sphere\nderive w: R0 => R1\n",
        options);
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("matches 2 shapes here"), std::string::npos);
    EXPECT_EQ(d.error().message.find("'R0'"), std::string::npos) << d.error().message;
}

}  // namespace
}  // namespace sgm
