#include <gtest/gtest.h>

#include "modeler/town/tensor_field.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

constexpr double whole = 1;

/// |sine| of the angle between two lines that may cross at right angles: 0 where they agree.
double off(Vec2 d, Vec2 axis) { return std::min(std::abs(cross(d, axis)), std::abs(dot(d, axis))); }

TEST(TensorField, IsARasterWhereNothingIsSaid) {
    RoadParameters p;
    p.axis = .3;
    const Land land;
    const TensorField field(p, land, {});
    const Vec2 axis = directionAt(.3);
    for (const Vec2 heading : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, .1}, Vec2{.3, -.9}}) {
        const Vec2 d = field.direction({120, -40}, unit(heading), 80);
        EXPECT_LT(off(d, axis), 1e-12);
        EXPECT_GT(dot(d, heading), .6 * length(heading));
        EXPECT_NEAR(length(d), 1, 1e-12);
    }
}

TEST(TensorField, HasRingsAboutItsCentre) {
    Land land;
    land.rings = [](Vec2) { return whole; };
    const RoadParameters p;
    const TensorField field(p, land, {50, 20});
    for (double a = 0; a < 6.2; a += .37) {
        const Vec2 out = directionAt(a), at = Vec2{50, 20} + out * 300;
        EXPECT_LT(off(field.direction(at, out, 0), out), 1e-9);
        // Half a piece on, so that chords of a ring end on it.
        const Vec2 round = field.direction(at, {-out.z, out.x}, 80);
        EXPECT_NEAR(length(at + round * 80 - Vec2{50, 20}), 300, 1);
    }
    EXPECT_EQ(field.direction({50, 20}, {0, 1}, 0), (Vec2{0, 1}));  // the middle tells nothing
}

TEST(TensorField, RunsAlongTheShoreWithinReach) {
    Land land;
    const Vec2 bank = directionAt(.5), inland{-bank.z, bank.x};
    land.water = [&](Vec2 p) { return dot(p, inland) < 0; };
    land.shore = [](Vec2) { return whole; };
    RoadParameters p;
    p.reach_m = 200;
    const TensorField field(p, land, {});
    for (double away = 10; away < 150; away += 20) {
        const Vec2 d = field.direction(bank * 70 + inland * away, {1, 0}, 0);
        EXPECT_LT(off(d, bank), .08) << away;
    }
    const auto strength = [&](double away) { return length(field.at(inland * away)); };
    EXPECT_GT(strength(10), strength(90));
    EXPECT_GT(strength(90), strength(170));
    EXPECT_EQ(strength(210), 0);
    EXPECT_EQ(field.direction(inland * 260, {1, 0}, 0), (Vec2{1, 0}));
}

TEST(TensorField, RunsAlongLevelLinesOfSteepGround) {
    Land land;
    land.height = [](Vec2 p) { return .1 * p.x + .05 * p.z; };
    land.contours = [](Vec2) { return whole; };
    const RoadParameters p;
    const TensorField field(p, land, {});
    const Vec2 level = unit({-.05, .1});
    EXPECT_LT(off(field.direction({0, 0}, {1, 0}, 80), level), 1e-6);
    EXPECT_NEAR(length(field.at({0, 0})), std::sqrt(.0125) / p.slope, 1e-6);
    land.height = [](Vec2) { return 7.; };
    EXPECT_EQ(length(field.at({0, 0})), 0);
}

TEST(TensorField, MixesItsPartsByWeight) {
    Land land;
    land.grid = [](Vec2 p) { return p.x < 0 ? 1. : 0.; };
    land.rings = [](Vec2 p) { return p.x < 0 ? 0. : 1.; };
    const RoadParameters p;
    const TensorField field(p, land, {0, 0});
    EXPECT_LT(off(field.direction({-200, 130}, {1, .2}, 0), {1, 0}), 1e-9);
    EXPECT_LT(off(field.direction({200, 130}, {1, .2}, 0), unit({200, 130})), 1e-9);
    // Equal parts: the sum of the tensors, whose direction is halfway.
    land.grid = land.rings = [](Vec2) { return whole; };
    EXPECT_LT(off(field.direction({200, 115.47}, {1, 0}, 0), directionAt(.2618)), 1e-4);
}

TEST(Roads, FollowTheField) {
    RoadParameters p;
    p.lo = {-600, -600}, p.hi = {600, 600};
    p.pattern = Pattern::Field;
    p.from = Vec2{0, -300};
    Land land;
    land.water = [](Vec2 q) { return q.z - .3 * q.x > 150; };
    land.shore = [](Vec2) { return 4.; };
    land.grid = [](Vec2) { return .2; };
    const auto graph = growRoads(p, land);
    ASSERT_TRUE(graph.ok());
    const Vec2 bank = unit({1, .3});
    double near = 0, along = 0, far = 0, square = 0;
    for (const RoadEdge& e : graph->edges()) {
        const Vec2 a = graph->metresAt(e.a), b = graph->metresAt(e.b), m = (a + b) * .5, d = unit(b - a);
        const double away = (150 - m.z + .3 * m.x) / std::sqrt(1.09), l = length(b - a);
        if (away < 90) near += l, along += off(d, bank) < .2 ? l : 0;
        if (away > 260) far += l, square += off(d, {1, 0}) < .2 ? l : 0;
    }
    EXPECT_GT(near, 1500);
    EXPECT_GT(along, .8 * near);
    EXPECT_GT(far, 3000);
    EXPECT_GT(square, .8 * far);
}

}  // namespace
}  // namespace sgm::town
