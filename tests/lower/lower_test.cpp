// Lowering: the order of combination, owners, materials, slots; seen by evaluating fields at points.
#include "grammar/lower/lower.h"

#include <algorithm>
#include <map>
#include <utility>

#include "modeler/core/random.h"
#include "modeler/field/plan_numbers.h"
#include "tests/cpu_time.h"
#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

TEST(Order, ADifferenceCutsWhatItsNodeHoldsSoFar) {
    // The ball comes after the cut and fills it again.
    const Lowered later("grammar 1\nstart S -> cube size 4 - cube size 2 + sphere size 1\n");
    EXPECT_TRUE(later.inside({0, 0, 0}));
    EXPECT_FALSE(later.inside({0.8f, 0, 0}));
    const Lowered before("grammar 1\nstart S -> cube size 4 + sphere size 1 - cube size 2\n");
    EXPECT_FALSE(before.inside({0, 0, 0}));
}

TEST(Order, ADifferenceCutsNothingElse) {
    const Lowered d("grammar 1\nstart S -> cube size 4, cube size 4 move (6, 0, 0) - cube size (20, 1, 1)\n");
    EXPECT_TRUE(d.inside({0, 0, 0}));  // the first sibling stays whole
    EXPECT_FALSE(d.inside({6, 0, 0}));
}

TEST(Order, IntersectionAndMorphTakeTheWhole) {
    const Lowered both("grammar 1\nstart S -> cube size 2 + cube size (6, 1, 1) & sphere size 4\n");
    EXPECT_TRUE(both.inside({1.5f, 0, 0}));
    EXPECT_FALSE(both.inside({2.5f, 0, 0}));
    // Eq. 14 between a ball of radius 1 and one of radius 3: radius 1·(1 − .25) + 3·.25.
    const Lowered melted("grammar 1\nstart S -> sphere size 2 morph sphere size 6 by .25\n");
    EXPECT_NEAR(melted.value({1.5f, 0, 0}), 0, 1e-5);
    const Lowered solid("grammar 1\nstart S -> morph(sphere, cube, .5) size 2\n");
    EXPECT_NEAR(solid.value({0, 0, 0}), -1, 1e-5);
}

TEST(Order, ConsecutiveBlendsAreOneMelt) {
    // Equal balls around a point: the blend doesn't depend on their order.
    const char* parts[] = {" + sphere size 2 move (1, 0, 0) blend .5", " + sphere size 2 move (0, 1, 0) blend .5"};
    const std::string head = "grammar 1\nstart S -> sphere size 2";
    const Lowered ab(head + parts[0] + parts[1] + "\n"), ba(head + parts[1] + parts[0] + "\n"),
        sharp(head + " + sphere size 2 move (1, 0, 0) + sphere size 2 move (0, 1, 0)\n");
    for (const Vec3f p : {Vec3f{0.9f, 0.9f, 0}, Vec3f{0.5f, 0.5f, 0.8f}}) {
        EXPECT_NEAR(ab.value(p), ba.value(p), 1e-6);
        EXPECT_LT(ab.value(p), sharp.value(p) - 1e-3);
    }
}

TEST(Order, AMeltedCutIsTheSharpOneFarFromItsEdge) {
    const std::string head = "grammar 1\nstart S -> cube size 4 - cube size 2 move (0, 2, 0)";
    const Lowered melted(head + " blend .5m\n"), sharp(head + "\n");
    int moved = 0;
    for (float x = -3; x < 3; x += 0.17f)
        for (float y = -1; y < 3; y += 0.13f) {
            const float m = melted.value({x, y, 0.1f}), s = sharp.value({x, y, 0.1f});
            EXPECT_GE(m, s - 1e-6f);  // a blend takes the edge off
            moved += m > s + 1e-3f;
        }
    EXPECT_GT(moved, 5);
    EXPECT_GT(melted.value({1.01f, 1.98f, 0}), 0);  // the edge, in the rock by 1 cm before
    EXPECT_LT(sharp.value({1.01f, 1.98f, 0}), 0);
    EXPECT_EQ(melted.value({0, -1.5f, 0}), sharp.value({0, -1.5f, 0}));
    EXPECT_EQ(melted.owner({1.0f, 1.4f, 0}).symbol(), sharp.owner({1.0f, 1.4f, 0}).symbol());
}

TEST(Order, DisplacementMovesTheWholeContent) {
    const Lowered plain("grammar 1\nstart S -> (cube size 2 + sphere size 2 at +y)\n");
    const Lowered rough("grammar 1\nstart S -> (cube size 2 + sphere size 2 at +y) displace billow(.1m, 2/m)\n");
    int changed = 0;
    for (float y = -1; y < 3; y += 0.25f)
        changed += std::abs(plain.value({1, y, 0.1f}) - rough.value({1, y, 0.1f})) > 1e-4f;
    EXPECT_GT(changed, 8);
    EXPECT_NE(rough.owner({1, 0, 0}).path, "");
}

TEST(Shapes, TurnedAndPlacedScopes) {
    const Lowered d("grammar 1\nstart S -> cube size (4, 1, 1) turn 90deg move (0, 0, 5)\n");
    EXPECT_TRUE(d.inside({0, 0, 6.8f}));
    EXPECT_FALSE(d.inside({1.5f, 0, 5}));
    EXPECT_TRUE(d.model->field.bounds.contains({0, 0, 6.9f}));
    EXPECT_FALSE(d.model->field.bounds.contains({1.5f, 0, 5}));
}

TEST(Owners, SurfaceTellsItsShapeAndLine) {
    const Lowered d(
        "grammar 1\nterminal wall color #ff0000\nterminal glass color #0000ff\nstart S -> wall : A\n"
        "rule Cut: A -> - cube size .5 at +x to centre, - glass size .5 at -x to centre, + sphere size .5 at +y to "
        "centre\n");
    const auto material = [&](const Part& p) { return d.model->provenance.materials[p.material].name; };
    EXPECT_EQ(d.owner({0, 0, 0.5f}).symbol(), "A");
    EXPECT_EQ(material(d.owner({0, 0, 0.5f})), "wall");
    const Part& cut = d.owner({0.25f, 0, 0});
    EXPECT_EQ(cut.rule(), "Cut");
    EXPECT_EQ(cut.line(), 5u);
    EXPECT_EQ(cut.file(), "test.sgm");
    EXPECT_EQ(material(cut), "wall");                       // the wall of a cut looks like its host
    EXPECT_EQ(material(d.owner({-0.25f, 0, 0})), "glass");  // unless the cutter names a material
    EXPECT_EQ(material(d.owner({0, 0.75f, 0})), "wall");    // inherited
    const Lowered one("grammar 1\nstart S -> sphere\n");
    EXPECT_EQ(one.owner({0.5f, 0, 0}).symbol(), "sphere");
    EXPECT_EQ(one.model->provenance.parts[0].symbol(), "sphere");
}

/// Paths of parts are made when asked for, and are those of the tree, which may be gone by then.
TEST(Owners, PathsOutliveTheTree) {
    std::string deep = "grammar 1\nstart S -> A0 + A0\n";
    for (int i = 0; i < 30; ++i) deep += "rule A" + std::to_string(i) + " -> A" + std::to_string(i + 1) + "\n";
    for (const std::string& text :
         {deep + "rule A30 -> cube + cube move (2, 0, 0)\n",
          std::string("grammar 1\nstart S -> (cube + sphere at +y) + A + A\nrule A -> cube - sphere at +x\n")}) {
        std::vector<std::string> paths;
        std::unique_ptr<lower::Model> model;
        {
            Lowered d(text);
            ASSERT_TRUE(d.model);
            for (const derive::ShapeId id : d.model->shapeOf)
                paths.push_back(d.derivation.tree.path(id == derive::none ? 0 : id));
            model = std::move(d.model);
        }
        ASSERT_GT(paths.size(), 3u);
        ASSERT_EQ(paths.size(), model->provenance.parts.size());
        for (size_t i = 0; i < paths.size(); ++i) EXPECT_EQ(model->provenance.parts[i].path.text(), paths[i]);
    }
}

TEST(Owners, ARoughenedSurfaceIsStillItsPartsOwn) {
    const Lowered d(
        "grammar 1\nterminal wall color #ff0000\nterminal glass color #0000ff\n"
        "start S -> (wall size 2 + glass size 1 at +y - cube size (4, .2, 4) move (0, .5, 0)) displace fbm(.05m, "
        "2/m)\n");
    EXPECT_EQ(d.owner({1, 0, 0}).symbol(), "wall");
    EXPECT_EQ(d.owner({0.5f, 1.5f, 0}).symbol(), "glass");
    EXPECT_EQ(d.owner({0, 0.4f, 0}).symbol(), "cube");
}

TEST(Owners, AMorphLooksLikeTheFirstOfItsSolidsThatHasALook) {
    const Lowered d(
        "grammar 1\nterminal wall color #ff0000\nterminal glass color #0000ff\n"
        "start S -> cube size 2 + morph(sphere, wall, .5) size 2 at +x + (glass + wall) size 2 at -x\n");
    const auto material = [&](Vec3f p) { return d.model->provenance.materials[d.owner(p).material].name; };
    EXPECT_EQ(material({2, 1, 0}), "wall");
    EXPECT_EQ(material({-2, 1, 0}), "glass");
    EXPECT_NE(material({0, 1, 0}), "wall");
}

TEST(Owners, TheFirstOfCoplanarPartsOwnsTheSurfaceAlsoBehindACut) {
    const std::string looks = "grammar 1\nterminal wall color #ff0000\nterminal band color #0000ff\n";
    for (const char* text :
         {"wall size (6, 4, .4) + band size (6, 1, .4)",
          "wall size (6, 4, .4) - cube size (1, 1, 2) move (2, 1.4, 0) + band size (6, 1, .4)",
          "(wall size (6, 4, .4) - cube size (1, 1, 2) move (2, 1.4, 0)) + band size (6, 1, .4)",
          "wall size (6, 4, .4) - cube size (1, 1, 2) move (2, 1.4, 0) + (band size (6, 1, .4) - cube size .1)",
          "wall size (6, 4, .4) & cube size 9 + band size (6, 1, .4)"}) {
        const Lowered d(looks + "start S -> " + text + "\n");
        EXPECT_EQ(d.model->provenance.materials[d.owner({-2, 0, .2f}).material].name, "wall") << text;
    }
}

TEST(Owners, WhatIsMorphedWithANewcomerLooksLikeTheFirstThatHasALook) {
    const std::string looks = "grammar 1\nterminal wall color #ff0000\nterminal glass color #0000ff\n";
    const auto look = [&](const std::string& text) {
        const Lowered d(looks + "start S -> " + text + "\nrule W -> wall\nrule G -> glass\nrule C -> cube\n");
        return d.model->provenance.materials[d.owner({0, .5f, 0}).material].name;
    };
    EXPECT_EQ(look("W morph G by .5"), "wall");
    EXPECT_EQ(look("C morph G by .5"), "glass");
    EXPECT_EQ(look("W morph C by .5"), "wall");
    EXPECT_EQ(look("wall morph sphere by .5"), "wall");
    EXPECT_EQ(look("W morph glass by .5"), "glass") << "its own";
}

TEST(Slots, AChangedNumberKeepsTheStructure) {
    const std::string text =
        "grammar 1\nparam r = 1 in .5..2\nstart S -> cube : A\nrule A repeat 5 -> + morph(sphere, cube, r / 2) size r "
        "at free() : A\n";
    derive::Options other;
    other.params = {rules::Value::number(1.5)};
    const Lowered a(text), b(text, other);
    const auto &ga = a.model->graph, &gb = b.model->graph;
    ASSERT_EQ(ga.nodeCount(), gb.nodeCount());
    ASSERT_EQ(ga.slotKeys().size(), gb.slotKeys().size());
    size_t changed = 0;
    for (size_t i = 0; i < ga.slotKeys().size(); ++i) {
        EXPECT_EQ(ga.slotKeys()[i], gb.slotKeys()[i]);
        changed += ga.constants()[i] != gb.constants()[i];
    }
    EXPECT_GT(changed, 10u);
}

TEST(Failures, NothingAndUnbounded) {
    const auto empty = lower::lower(derived("grammar 1\nstart S -> nil\n"), nullptr);
    ASSERT_FALSE(empty.ok());
    EXPECT_NE(empty.error().message.find("nothing solid"), std::string::npos);
    Progress progress;
    progress.cancel();
    const auto big = derived("grammar 1\nstart S -> cube : A\nrule A repeat 600 -> + cube at +y : A\n");
    const auto stopped = lower::lower(big, &progress);
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().kind, Error::Kind::Cancelled);
}

TEST(Scale, CavesAndCloudsOfThousands) {
    const double begin = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    derive::Options cells;
    cells.params = {rules::Value::number(2000)};
    const auto text = grammarOf(cave);
    for (size_t i = 1; i < text->params.size(); ++i) cells.params.push_back(text->params[i].value);
    const Lowered big(cave, cells);
    EXPECT_EQ(big.derivation.terminals(), 2001u);
    derive::Options reach;
    reach.params = {grammarOf(cloud)->params[0].value};
    for (size_t i = 0; i < 6; ++i) reach.params[0].n[i] = 40;
    const Lowered puffs(cloud, reach);
    EXPECT_EQ(puffs.derivation.terminals(), 6u * 820 + 2);
    // A tree 2,000 deep, not only wide.
    const Lowered deep(
        "grammar 1\nstart S -> cube : X\nrule X when scope.x > .8 -> + sphere size (scope.x - .0001, 1, 1) at +y : "
        "X\n");
    EXPECT_GT(deep.derivation.tree.shapes.back().depth, 1990u);
    EXPECT_TRUE(deep.inside({0, 1000, 0}));
    EXPECT_LT(secondsOf(CLOCK_PROCESS_CPUTIME_ID) - begin, boundSeconds(3));
}

TEST(Determinism, EqualDerivationsGiveEqualGraphs) {
    const Lowered a(house), b(house);
    ASSERT_EQ(a.model->graph.nodeCount(), b.model->graph.nodeCount());
    for (field::NodeId i = 0; i < a.model->graph.nodeCount(); ++i) {
        EXPECT_EQ(a.model->graph.node(i).op, b.model->graph.node(i).op);
        EXPECT_EQ(a.model->graph.node(i).first, b.model->graph.node(i).first);
    }
    EXPECT_TRUE(std::equal(a.model->graph.constants().begin(), a.model->graph.constants().end(),
                           b.model->graph.constants().begin()));
}

/// Boxes are made by several threads, chunk by chunk; solids of other kinds, rotations and cuts lie between them.
TEST(Determinism, NothingOfTheThreadsShowsInAModel) {
    const auto d = derived(
        "grammar 2\nterminal brick, glass\n"
        "start City -> for k in 1..3 { Wall size (150m, 120m, .5m) turn (20deg * k) move (0, 0, 9m * k) }\n"
        "rule Wall -> split y { { ~.9m: split x { { ~1m: Tile }* } }* }\n"
        "rule Tile weight 30 -> split x { ~.2: brick | ~1: glass }\n"
        "rule Tile weight 1 -> brick + sphere size (.3m, .3m, .3m) at +z\n"
        "rule Tile weight 1 -> brick - cube size (.3m, .3m, 1m)\n");
    ASSERT_GT(d.terminals(), 60'000u);
    const auto one = lower::lower(d, nullptr, 1);
    ASSERT_TRUE(one.ok()) << one.error().message;
    const field::Graph& expected = (*one)->graph;
    for (const int threads : {2, 3, 0}) {
        const auto many = lower::lower(d, nullptr, threads);
        ASSERT_TRUE(many.ok());
        const field::Graph& graph = (*many)->graph;
        ASSERT_EQ(graph.nodeCount(), expected.nodeCount());
        ASSERT_EQ((*many)->field.value.id(), (*one)->field.value.id());
        for (field::NodeId i = 0; i < graph.nodeCount(); ++i) {
            ASSERT_EQ(graph.node(i).op, expected.node(i).op);
            ASSERT_EQ(graph.node(i).data, expected.node(i).data);
            ASSERT_TRUE(std::equal(graph.operands(i).begin(), graph.operands(i).end(), expected.operands(i).begin(),
                                   expected.operands(i).end()));
        }
        EXPECT_TRUE(std::equal(graph.constants().begin(), graph.constants().end(), expected.constants().begin()));
        EXPECT_TRUE(std::equal(graph.slotKeys().begin(), graph.slotKeys().end(), expected.slotKeys().begin()));
        EXPECT_EQ((*many)->shapeOf, (*one)->shapeOf);
        const auto &parts = (*many)->provenance.parts, &expectedParts = (*one)->provenance.parts;
        ASSERT_EQ(parts.size(), expectedParts.size());
        for (size_t i = 0; i < parts.size(); i += 97) {
            EXPECT_EQ(parts[i].path, expectedParts[i].path);
            EXPECT_EQ(parts[i].pose, expectedParts[i].pose);
            EXPECT_EQ(parts[i].material, expectedParts[i].material);
        }
    }
}

/// A box's numbers stand in the slots of its own shape, and its part is its own, wherever it lies in a row.
TEST(Slots, EveryBoxHasThoseOfItsShape) {
    const auto d = derived(
        "grammar 2\nterminal brick, glass\nstart Wall -> Front size (90m, 60m, .5m) turn 30deg\n"
        "rule Front -> split y { { ~1m: split x { { ~.9m: brick | .3m: glass }* } }* }\n");
    auto model = lower::lower(d, nullptr);
    ASSERT_TRUE(model.ok());
    const field::Graph& graph = (*model)->graph;
    std::map<std::pair<uint64_t, uint64_t>, float> values;
    for (size_t slot = 0; slot < graph.constants().size(); ++slot) {
        const field::SlotKey key = graph.slotKeys()[slot];
        EXPECT_TRUE(values.try_emplace({key.path, key.attribute}, graph.constants()[slot]).second) << slot;
    }
    ASSERT_EQ((*model)->shapeOf.size(), d.terminals() + 1);
    for (size_t part = 1; part < (*model)->shapeOf.size(); ++part) {
        const derive::Shape& shape = d.tree.shapes[(*model)->shapeOf[part]];
        const Vec3f half = shape.scope.half().as<float>();
        EXPECT_EQ(values.at({shape.key, hashText("size.x")}), half.x);
        EXPECT_EQ(values.at({shape.key, hashText("size.y")}), half.y);
        EXPECT_EQ(values.at({shape.key, hashText("size.z")}), half.z);
        EXPECT_EQ((*model)->provenance.parts[part].pose.origin, shape.scope.centre);
    }
}

/// Derivation searches the depth of a roof's plan for its height; lowering gets that of its own plan and formula.
TEST(Roofs, TheirDepthsAreKnownFromTheirHeights) {
    const auto d = derived(
        "grammar 2\nterminal wall\n"
        "start Row -> for k in 1..5 { House footprint ell(15 + k, 12, 5, 5) extrude 4m move (30m * k, 0, 0) }\n"
        "rule House -> wall + hipRoof(35deg, overhang: .4m) at +y\n");
    const derive::Footprints& footprints = d.tree.footprints;
    size_t roofs = 0;
    for (const derive::Shape& shape : d.tree.shapes) {
        if (shape.solid == derive::none || d.tree.solids[shape.solid].primitive->name != "hipRoof") continue;
        const Vec3d half = shape.scope.half();
        const plan::Footprint plan = footprints.inMetres(shape.scope.footprint, half);
        const auto depth_m = footprints.knownDepth(shape.scope.footprint, half);
        ASSERT_TRUE(depth_m);
        EXPECT_EQ(*depth_m, field::PlanNumbers(plan, footprints[shape.scope.footprint].formula).depth());
        EXPECT_FALSE(footprints.knownDepth(shape.scope.footprint, half * 2));
        ++roofs;
    }
    EXPECT_EQ(roofs, 5u);
}

TEST(Order, NothingIsSharedWithTheEmptyShape) {
    for (const char* text : {"start S -> cube size 2 & A\nrule A -> nil\n", "start S -> cube size 2 & nil\n"}) {
        const auto d = derived(std::string("grammar 1\n") + text);
        const auto result = lower::lower(d, nullptr);
        ASSERT_FALSE(result.ok()) << text;
        EXPECT_NE(result.error().message.find("nothing solid is left"), std::string::npos);
    }
    const Lowered later("grammar 1\nstart S -> cube size 2 & A + sphere size 1\nrule A -> nil\n");
    EXPECT_TRUE(later.inside({0, 0, 0}));
    EXPECT_FALSE(later.inside({0.8f, 0, 0}));
}

/// Parts of a turned wall share their dot products; turned by quarters they need none.
TEST(Rotations, ATurnedWallHasTheTapeOfAStraightOne) {
    const auto wall = [](const std::string& turn) {
        return Lowered("grammar 1\nterminal brick, glass\nstart F -> Wall size (30, 20, .6)" + turn +
                       "\nrule Wall -> split y { { ~3m: split x { { ~2m: brick | 1m: glass }* } }* }\n");
    };
    const Lowered straight = wall(""), quarter = wall(" turn 90deg"), turned = wall(" turn 30deg"),
                  tilted = wall(" turn (10deg, 30deg, -5deg)");
    EXPECT_GT(straight.tape().size(), 100u);
    EXPECT_LE(quarter.tape().size(), straight.tape().size() + 2);
    EXPECT_LE(turned.tape().size(), straight.tape().size() + 20);
    EXPECT_LE(tilted.tape().size(), straight.tape().size() + 20);
}

}  // namespace
}  // namespace sgm
