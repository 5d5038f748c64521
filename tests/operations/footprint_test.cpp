// Footprints of scopes: what operations make of them, what fills them, and what splits leave.
#include <gtest/gtest.h>

#include <cmath>

#include "modeler/core/random.h"
#include "tests/lower/lowered.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::Shape;

plan::Footprint footprintOf(const Derivation& d, const Shape& s) {
    if (s.scope.footprint == derive::none) return plan::Footprint{};
    return d.tree.footprints.inMetres(s.scope.footprint, s.scope.half());
}

/// All shapes of a label that hold a solid.
std::vector<Shape> solidsCalled(const Derivation& d, const std::string& label) {
    std::vector<Shape> found;
    for (const Shape& s : d.tree.shapes)
        if (s.solid != derive::none && d.tree.labels[s.label] == label) found.push_back(s);
    return found;
}

/// The only solid of a label, its footprint's area.
double areaOf(const std::string& text) {
    const Derivation d = derived("grammar 1\nterminal wall\n" + text);
    const auto walls = solidsCalled(d, "wall");
    EXPECT_EQ(walls.size(), 1u);
    if (walls.empty()) return 0;
    const Shape& s = walls[0];
    return s.scope.footprint == derive::none ? s.scope.size.x * s.scope.size.z : area(footprintOf(d, s));
}

std::string errorOf(const std::string& text) {
    const auto d = tryDerive("grammar 1\nterminal wall\n" + text);
    return d.ok() ? "" : d.error().message;
}

TEST(Footprints, APlanInMetresSetsTheSizeAndAnExtrusionKeepsTheFoot) {
    const Derivation d = derived(
        "grammar 1\nterminal wall\nstart A -> footprint ell(16, 12, 6, 5) extrude 7m Mass\nrule Mass -> wall\n");
    const Shape s = solidsCalled(d, "wall")[0];
    expectNear(s.scope.size, {16, 7, 12});
    expectNear(s.scope.centre, {0, -.5 + 3.5, 0});  // the root's foot is at -.5
    EXPECT_NEAR(area(footprintOf(d, s)), 16 * 6 + 5 * 6, 1e-9);
}

TEST(Footprints, ASizeWithAShareStretchesThePlan) {
    const auto areaWith = [](int version, const std::string& size) {
        const Derivation d = derived("grammar " + std::to_string(version) +
                                     "\nterminal wall\nstart A -> footprint ell(16, 12, 6, 5) extrude 7m Mass\n"
                                     "rule Mass -> wall size " +
                                     size + "\n");
        const Shape s = solidsCalled(d, "wall")[0];
        return s.scope.footprint == derive::none ? 0 : area(footprintOf(d, s));
    };
    const double whole = 16 * 6 + 5 * 6;
    EXPECT_NEAR(areaWith(2, "(50%, 100%, 100%)"), whole / 2, 1e-9);
    EXPECT_NEAR(areaWith(2, "(100% - 8m, 100%, 100%)"), whole / 2, 1e-9);
    EXPECT_NEAR(areaWith(2, "(100% - 4m)"), whole * 12 / 16 * 8 / 12, 1e-9);
    EXPECT_NEAR(areaWith(2, "(choose { 1: 100% - 8m }, 100%, 100%)"), whole / 2, 1e-9);
    for (const char* box : {"(8m, 100%, 100%)", "(100%, 100%, 8m)", "(scope.x - 8m, 100%, 100%)", "8m"})
        EXPECT_EQ(areaWith(2, box), 0) << box;
    EXPECT_EQ(areaWith(1, "(100% - 8m, 100%, 100%)"), 0);
}

TEST(Footprints, AJointPlacesWhatIsExtruded) {
    const std::pair<const char*, Vec3d> cases[] = {{"+ footprint rect(2, 2) extrude 1m wall at +y", {0, 2.5, 0}},
                                                   {"+ wall at +y extrude 6m", {0, 5, 0}},
                                                   {"+ footprint rect(2, 2) extrude 1m wall at +z", {0, 0, 3}},
                                                   {"- wall extrude 1m at +y to centre", {0, 2, 0}},
                                                   {"+ wall extrude 6m", {0, 1, 0}}};
    for (const auto& [grown, centre] : cases) {
        const Derivation d =
            derived("grammar 2\nterminal wall\nstart A -> cube size 4 : B\nrule B -> " + std::string(grown) + "\n");
        const auto walls = solidsCalled(d, "wall");
        ASSERT_EQ(walls.size(), 1u) << grown;
        SCOPED_TRACE(grown);
        expectNear(walls[0].scope.centre, centre);
    }
}

TEST(Footprints, ATerminalWithoutASolidFillsItAndACubeIsABox) {
    const std::string plan = "start A -> footprint ell(16, 12, 6, 5) extrude 4m ";
    const Lowered wall("grammar 1\nterminal wall\n" + plan + "wall\n"), cube("grammar 1\n" + plan + "cube\n");
    const Derivation& d = wall.derivation;
    const Shape s = solidsCalled(d, "wall")[0];
    const plan::Footprint footprint = footprintOf(d, s);
    size_t tried = 0;
    for (uint64_t i = 0; i < 2000; ++i) {
        const plan::Vec2 p{uniform(combine(1, i), -9, 9), uniform(combine(2, i), -7, 7)};
        if (distanceToEdges(footprint, p) < 1e-4) continue;
        ++tried;
        const Vec3f at{static_cast<float>(p.x), 1, static_cast<float>(p.z)};
        EXPECT_EQ(wall.inside(at), contains(footprint, p)) << p.x << ' ' << p.z;
        EXPECT_EQ(cube.inside(at), std::abs(p.x) < 8 && std::abs(p.z) < 6);
    }
    EXPECT_GT(tried, 1900u);
}

TEST(Footprints, PlansAreUnitedAndCutWithPlacesOfTheirOwn) {
    EXPECT_NEAR(areaOf("start A -> footprint (rect(10, 4) + rect(4, 10)) wall\n"), 40 + 40 - 16, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint (rect(10, 4) - rect(2, 2, at: (4, 0))) wall\n"), 40 - 4, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint (rect(10, 4) + rect(10, 4, at: (0, 20), turn: 90deg)) wall\n"), 80, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint outline((0, 0), (8, 0), (8, 6)) wall\n"), 24, 1e-9);
}

TEST(Footprints, SharesFillTheScopeAndStretchWithIt) {
    EXPECT_NEAR(
        areaOf("start A -> size (8, 3, 6) B\nrule B -> footprint outline((0%, 0%), (100%, 0%), (50%, 100%)) wall\n"),
        24, 1e-9);
    EXPECT_NEAR(areaOf("start A -> wall footprint ngon(4) size (8, 3, 6)\n"), 48, 1e-9);
    EXPECT_NEAR(areaOf("start A -> footprint ngon(4) size (8, 3, 6) wall\n"), 48, 1e-9);
    EXPECT_NEAR(areaOf("start A -> footprint ngon(4) wall size (8, 3, 6)\n"), 48, 1e-9);
    EXPECT_NEAR(areaOf("start A -> footprint ell(8, 8, 4, 4) B\nrule B -> wall size (200%, 100%, 50%)\n"), 48, 1e-9);
}

TEST(Footprints, AnAbsoluteSizeIsABox) {
    EXPECT_NEAR(areaOf("start A -> footprint ngon(6, 5m) B\nrule B -> wall size (2, 3, 2)\n"), 4, 1e-9);
}

TEST(Footprints, OffsetSetbackCourtAndInnerChangeThePlan) {
    EXPECT_NEAR(areaOf("start A -> footprint rect(10, 6) offset 1m wall\n"), 12 * 8, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint rect(10, 6) setback 1m wall\n"), 8 * 4, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint rect(10, 6) setback edges(front: 2m, rest: 1m) wall\n"), 8 * 3, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint rect(10, 6) court 2m wall\n"), 60 - 6 * 2, 1e-3);
    EXPECT_NEAR(areaOf("start A -> footprint ell(10, 8, 3, 4) inner wall\n"), 32, 1e-2);
}

TEST(Footprints, ASetbackMovesTheScopeToWhatIsLeft) {
    const Derivation d =
        derived("grammar 1\nterminal wall\nstart A -> footprint rect(10, 6) setback edges(front: 2m) wall\n");
    expectNear(solidsCalled(d, "wall")[0].scope.centre, {0, 0, -1}, 1e-3);
}

TEST(Footprints, WhereNothingIsLeftNoShapeIsMade) {
    const Derivation d = derived(
        "grammar 1\nterminal wall\nstart A -> footprint rect(10, 6) B\nrule B -> wall, Inner\nrule Inner -> setback 4m "
        "wall size 50%\n");
    EXPECT_EQ(solidsCalled(d, "wall").size(), 1u);
}

TEST(Footprints, ASplitClipsThem) {
    const Derivation d = derived(
        "grammar 1\nterminal wall, glass\nstart A -> footprint ell(16, 12, 6, 5) extrude 4m Mass\n"
        "rule Mass -> split x { 4m: wall | ~1: glass }\n");
    const Shape wall = solidsCalled(d, "wall")[0], glass = solidsCalled(d, "glass")[0];
    EXPECT_NEAR(wall.scope.size.x, 4, 1e-9);
    EXPECT_EQ(wall.scope.footprint, derive::none) << "a rectangle is a box";
    EXPECT_NEAR(area(footprintOf(d, glass)), 16 * 6 + 5 * 6 - 4 * 12, 1e-3);
}

TEST(Footprints, ARoofIsAsHighAsItsPitchMakesItAndStandsOnItsHost) {
    const Derivation d = derived(
        "grammar 1\nterminal wall\nterminal tiles = hipRoof(45deg)\nstart A -> footprint rect(10, 6) extrude 4m Mass\n"
        "rule Mass -> wall + tiles at +y\n");
    const Shape roof = solidsCalled(d, "tiles")[0];
    EXPECT_NEAR(roof.scope.size.y, 3, .02);
    EXPECT_NEAR(roof.scope.point({0, -1, 0}).y, 3.5, 1e-9);
    const Lowered model("grammar 1\nstart A -> footprint rect(10, 6) hipRoof(45deg)\n");
    EXPECT_TRUE(model.inside({0, 2.4f, 0}));
    EXPECT_FALSE(model.inside({0, 2.6f, 0}));
    EXPECT_FALSE(model.inside({4.9f, 0, 0}));
}

TEST(Footprints, EveryRoofStandsOverAnyPlanAndOverNone) {
    for (const field::Primitive& row : field::primitives()) {
        if (row.plan == field::PlanUse::None) continue;
        for (const char* plan : {"footprint yard(14, 12, 4) ", "footprint ring(20, 16, 5) ", "footprint ngon(7, 5m) ",
                                 "size (9, 3, 6) "}) {
            const Lowered model("grammar 1\nstart A -> " + std::string(plan) + "extrude 3m B\nrule B -> " +
                                std::string(row.name) + "\n");
            ASSERT_TRUE(model.model) << row.name << ' ' << plan;
            EXPECT_FALSE(model.model->field.bounds.empty()) << row.name;
        }
    }
}

TEST(Footprints, OutlinesOfAFileKeepTheirPlace) {
    plan::Features features;
    for (const double x : {-20.0, 30.0})
        features.list.push_back(
            {"", plan::footprintOf(plan::polygonOf({{x, 0}, {x + 8, 0}, {x + 8, 6}, {x, 6}})), {}, 1});
    rules::Loader loader;
    loader.outlines = [&](const std::string& name, const syntax::Source&,
                          std::string& why) -> std::shared_ptr<const plan::Features> {
        if (name == "lots.geojson") return std::make_shared<const plan::Features>(features);
        why = "there is no such file";
        return nullptr;
    };
    const auto load = [&](const std::string& file, syntax::Diagnostics& diagnostics) {
        const auto text =
            "grammar 1\nterminal wall\nstart A -> for k in 1..2 { wall footprint file(\"" + file + "\", k) }\n";
        return rules::load(std::make_shared<const syntax::Source>("f.sgm", text), operations::table(), loader,
                           diagnostics);
    };
    syntax::Diagnostics diagnostics;
    const auto grammar = load("lots.geojson", diagnostics);
    ASSERT_TRUE(grammar);
    const auto d = derive::derive(grammar, {}, nullptr);
    ASSERT_TRUE(d.ok()) << d.error().message;
    const auto walls = solidsCalled(*d, "wall");
    ASSERT_EQ(walls.size(), 2u);
    expectNear(walls[0].scope.centre, {-16, 0, 3}, 1e-3);
    expectNear(walls[1].scope.centre, {34, 0, 3}, 1e-3);
    EXPECT_FALSE(load("other.svg", diagnostics));
    EXPECT_EQ(diagnostics.all().back().message, "can't use \"other.svg\": there is no such file");
}

TEST(Footprints, WhatCannotBeDrawnIsSaidWhereItStands) {
    EXPECT_NE(errorOf("start A -> footprint outline((0, 0), (4, 4), (4, 0), (0, 4)) wall\n").find("test.sgm:3"),
              std::string::npos);
    EXPECT_NE(errorOf("start A -> footprint ell(4, 4, 9, 1) wall\n").find("wing"), std::string::npos);
    EXPECT_NEAR(areaOf("start A -> footprint rect(4, 4) court 3m wall\n"), 16, 1e-9) << "wings leave no court";
    // Faults tell places as they are written, not from the middle of the plan.
    EXPECT_NE(
        errorOf("start A -> footprint outline((7, 5), (11, 9), (11, 5), (7, 8)) wall\n").find("near (8.71429, 6.71"),
        std::string::npos);
    EXPECT_NE(errorOf("start A -> footprint outline((150000, 0), (150004, 0), (150004, 5), (150000, 5)) wall\n")
                  .find("begins at (150000, 0), too far from the origin"),
              std::string::npos);
}

}  // namespace
}  // namespace sgm::testing_
