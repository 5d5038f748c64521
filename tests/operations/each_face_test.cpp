// `at each(…)`: newcomers on sides, corners and the faces of roofs.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/lower/lowered.h"
#include "tests/operations/shapes_called.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::Shape;

Derivation house(const std::string& rule, const std::string& plan = "ell(16, 12, 6, 5)") {
    return derived("grammar 1\nterminal wall\nterminal bay = cube\nstart A -> footprint " + plan +
                   " extrude 6m Mass\nrule Mass -> wall " + rule + "\n");
}

TEST(EachFace, SidesAreAsLongAsTheirEdgesAndLookOutward) {
    const Derivation d = house("+ bay size (100%, 50%, 1m) at each(side)");
    const auto bays = shapesCalled(d, "bay");
    ASSERT_EQ(bays.size(), 6u);
    double around = 0;
    for (const Shape& bay : bays) {
        around += bay.scope.size.x;
        EXPECT_NEAR(bay.scope.size.y, 3, 1e-9);
        EXPECT_NEAR(bay.scope.axes.y.y, 1, 1e-12);
        EXPECT_NEAR(dot(cross(bay.scope.axes.x, bay.scope.axes.y), bay.scope.axes.z), 1, 1e-12);
    }
    EXPECT_NEAR(around, 56, 1e-9) << "the outline's length";
}

TEST(EachFace, WordsAndTagsChooseEdges) {
    EXPECT_EQ(shapesCalled(house("+ bay size (1, 1, 1) at each(front)"), "bay").size(), 2u);
    EXPECT_EQ(shapesCalled(house("+ bay size (1, 1, 1) at each(court)", "ring(30, 24, 7)"), "bay").size(), 4u);
    EXPECT_EQ(
        shapesCalled(house("+ bay size (1, 1, 1) at each(outer)", "arc(33m, 44m, 15deg, 130deg, 12)"), "bay").size(),
        12u);
    EXPECT_EQ(shapesCalled(house("+ bay size (1, 1, 1) at each(nowhere)"), "bay").size(), 0u);
}

TEST(EachFace, ANewcomerStandsOutsideOfTheWall) {
    const Derivation d = house("+ bay size (1, 1, .4m) at each(front)", "rect(10, 6)");
    const Shape bay = shapesCalled(d, "bay")[0];
    expectNear(bay.scope.centre, {0, 2.5, 3.2});
    const Derivation centred = house("+ bay size (1, 1, .4m) at each(front) to centre", "rect(10, 6)");
    expectNear(shapesCalled(centred, "bay")[0].scope.centre, {0, 2.5, 3});
}

TEST(EachFace, CornersThatStandOutAlone) {
    EXPECT_EQ(shapesCalled(house("+ bay size (1, 100%, 1) at each(corner) to centre"), "bay").size(), 5u);
    const Derivation d = house("+ bay size (1, 100%, 1) at each(corner) to centre", "rect(10, 6)");
    for (const Shape& bay : shapesCalled(d, "bay")) {
        EXPECT_NEAR(std::abs(bay.scope.centre.x), 5, 1e-9);
        EXPECT_NEAR(std::abs(bay.scope.axes.z.x), std::sqrt(.5), 1e-9);
    }
}

TEST(EachFace, SlopesOfRoofsLieOnTheRoof) {
    for (const std::string roof : {"hipRoof(35deg, overhang: .5m, fascia: .2m)", "gableRoof(40deg, overhang: .4m)",
                                   "halfHipRoof(40deg)", "mansardRoof(70deg, 2m, 20deg)",
                                   "gambrelRoof(65deg, 2m, 25deg)", "saltboxRoof(45deg, 25deg)", "shedRoof(15deg)"}) {
        for (const std::string plan :
             {"rect(14, 9)", "ell(16, 12, 6, 5)", "outline((0, 0), (14, 1), (13, 9), (-1, 8))"}) {
            const std::string text = "grammar 1\nterminal bay = cube\nstart A -> footprint " + plan + " " + roof;
            const Lowered alone(text + "\n");
            const Derivation d = derived(text + " + bay size .2m at each(slope)\n");
            const auto bays = shapesCalled(d, "bay");
            EXPECT_FALSE(bays.empty()) << roof << " over " << plan;
            for (const Shape& bay : bays)
                EXPECT_NEAR(alone.value(bay.scope.centre.as<float>()), 0, 1e-4) << roof << " over " << plan;
        }
    }
}

TEST(EachFace, GablesEavesAndApexesHaveTheirPlaces) {
    const std::string text =
        "grammar 1\nterminal bay = cube\nterminal top = cube\nterminal gutter = cube\n"
        "start A -> footprint rect(12, 8) gableRoof(45deg) + bay size .2m at each(gable) to centre + top size .2m at "
        "each(apex) "
        "+ gutter size (100%, .1m, .1m) at each(eave)\n";
    const Derivation d = derived(text);
    EXPECT_EQ(shapesCalled(d, "bay").size(), 2u);
    ASSERT_EQ(shapesCalled(d, "gutter").size(), 2u);
    EXPECT_NEAR(shapesCalled(d, "gutter")[0].scope.size.x, 12, 1e-9);
    ASSERT_EQ(shapesCalled(d, "top").size(), 1u);
    EXPECT_NEAR(shapesCalled(d, "top")[0].scope.centre.y, -.5 + 4 + .1, .02) << "4 m above the eaves";
}

TEST(EachFace, RidgesHipsAndValleysAreWhereSlopesMeet) {
    const auto lines = [](const std::string& plan, const std::string& roof, const std::string& kind) {
        const Derivation d = derived("grammar 1\nterminal bay = cube\nstart A -> footprint " + plan + " " + roof +
                                     " + bay size (100%, .2m, .2m) at each(" + kind + ")\n");
        std::vector<double> lengths;
        for (const Shape& bay : shapesCalled(d, "bay")) lengths.push_back(bay.scope.size.x);
        return lengths;
    };
    const auto expect = [](const std::vector<double>& found, const std::vector<double>& expected) {
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9);
    };
    const double hip = std::sqrt(48.0), roofed = std::sqrt(75.0);
    expect(lines("rect(12, 8)", "hipRoof(45deg)", "ridge"), {4});
    expect(lines("rect(12, 8)", "hipRoof(45deg)", "hip"), {hip, hip, hip, hip});
    expect(lines("rect(12, 8)", "hipRoof(45deg, overhang: 1m)", "hip"), {roofed, roofed, roofed, roofed});
    expect(lines("rect(12, 8)", "hipRoof(45deg)", "valley"), {});
    expect(lines("rect(12, 8)", "gableRoof(30deg, overhang: .5m)", "ridge"), {13});
    expect(lines("ngon(4)", "hipRoof(45deg)", "ridge"), {});
    EXPECT_EQ(lines("ell(16, 12, 6, 5)", "hipRoof(40deg)", "valley").size(), 1u);
    EXPECT_EQ(lines("ell(16, 12, 6, 5)", "hipRoof(40deg)", "ridge").size(), 2u);
    EXPECT_EQ(lines("tee(16, 12, 5, 6)", "gableRoof(40deg)", "valley").size(), 2u);
    EXPECT_EQ(lines("ring(30, 24, 7)", "hipRoof(40deg)", "valley").size(), 4u);
    EXPECT_TRUE(lines("rect(12, 8)", "domeRoof", "ridge").empty());
    const std::string wings =  // four of one width, whose ridges cross at their middles
        "outline((-10, -3), (-3, -3), (-3, -10), (3, -10), (3, -3), (10, -3), (10, 3), (3, 3), (3, 10), (-3, 10), "
        "(-3, 3), (-10, 3))";
    expect(lines(wings, "gableRoof(45deg)", "ridge"), {20, 20});
    expect(lines(wings, "hipRoof(45deg)", "ridge"), {14, 14});
}

TEST(EachFace, LinesOfRoofsLieOnTheRoof) {
    for (const std::string roof : {"hipRoof(35deg, overhang: .5m, fascia: .2m)", "gableRoof(40deg, overhang: .4m)",
                                   "halfHipRoof(40deg)", "mansardRoof(70deg, 2m, 20deg)", "saltboxRoof(45deg, 25deg)"})
        for (const std::string plan :
             {"rect(14, 9)", "ell(16, 12, 6, 5)", "yard(20, 16, 5)", "outline((0, 0), (14, 1), (13, 9), (-1, 8))"}) {
            const std::string text = "grammar 1\nterminal bay = cube\nstart A -> footprint " + plan + " " + roof;
            const Lowered alone(text + "\n");
            for (const std::string kind : {"ridge", "hip", "valley"}) {
                const Derivation d = derived(text + " + bay size (100%, .2m, .2m) at each(" + kind + ")\n");
                for (const Shape& bay : shapesCalled(d, "bay"))
                    for (const double at : {-.45, -.2, .1, .45}) {
                        const Vec3d p = bay.scope.point({2 * at, 0, 0});
                        EXPECT_NEAR(alone.value(p.as<float>()), 0, 1e-4) << roof << " over " << plan << " " << kind;
                        EXPECT_GT(bay.scope.axes.y.y, .2) << "upright";
                    }
            }
        }
}

TEST(EachFace, LinesOfRoofsOverTooManyEdgesAreRefused) {
    const auto d = tryDerive("grammar 1\nstart A -> footprint round(200, 9m) hipRoof(30deg) + cube at each(hip)\n");
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("at most 128 edges"), std::string::npos) << d.error().message;
}

TEST(EachFace, RoofsThatCameBeforeAreFoundAndNoneIsAnError) {
    const Derivation d = house("+ hipRoof(30deg) at +y + bay size .5m at each(slope)", "rect(10, 6)");
    EXPECT_EQ(shapesCalled(d, "bay").size(), 4u);
    const auto none = tryDerive("grammar 1\nstart A -> cube + sphere at each(slope)\n");
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().message.find("no roof stands here"), std::string::npos) << none.error().message;
}

TEST(EachFace, TheApexIsWhereTheRoofEnds) {
    for (const char* roof : {"mansardRoof(70deg, height: 1m)", "gambrelRoof(70deg, height: 1m)", "hipRoof(40deg)",
                             "gableRoof(40deg, ends: all)"}) {
        const Derivation d =
            house(std::string("+ ") + roof + " at +y + bay size .2m at each(apex) to centre", "rect(12, 8)");
        const auto bays = shapesCalled(d, "bay");
        ASSERT_EQ(bays.size(), 1u) << roof;
        double top = 0;
        for (const Shape& s : d.tree.shapes)
            if (s.symbol != bays[0].symbol) top = std::max(top, s.scope.centre.y + s.scope.size.y / 2);
        EXPECT_NEAR(bays[0].scope.centre.y, top, .02)
            << roof << ": the deepest point is known to a thousandth of the width";
        EXPECT_GT(top, 3.5) << roof;
    }
}

TEST(EachFace, TheApexOfASaltboxIsOnItsRidge) {
    const Derivation d =
        house("+ saltboxRoof(60deg, 20deg) at +y + bay size .2m at each(apex) to centre", "rect(12, 8)");
    const auto bays = shapesCalled(d, "bay");
    ASSERT_EQ(bays.size(), 1u);
    constexpr double degree = 3.14159265358979 / 180, wall_m = 5.5;
    const double ridge_m = 8 / (1 / std::tan(60 * degree) + 1 / std::tan(20 * degree));
    EXPECT_NEAR(bays[0].scope.centre.y, wall_m + ridge_m, .002);
    EXPECT_NEAR(bays[0].scope.centre.z, 4 - ridge_m / std::tan(60 * degree), .002);
}

}  // namespace
}  // namespace sgm::testing_
