#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "modeler/core/conventions.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

std::vector<Argument> randomArguments(Graph& graph, const Primitive& row, Draws& draw) {
    std::vector<Argument> list;
    for (const PrimitiveParameter& p : row.parameters) {
        const double a = draw.uniform(p.lo, p.hi);
        if (p.kind == ParameterKind::File)
            list.push_back(fileArgument());
        else if (p.kind == ParameterKind::Rotation)
            list.push_back(argument(graph, draw.uniform(0, 1) < 0.3 ? Mat3{} : draw.rotation()));
        else if (p.kind == ParameterKind::Vector)
            list.push_back(argument(graph, {a, draw.uniform(p.lo, p.hi), draw.uniform(p.lo, p.hi)}));
        else if (p.kind == ParameterKind::PerId)
            list.push_back(argument(graph, {a, draw.uniform(0, 1) < 0.3 ? a : draw.uniform(p.lo, p.hi), a / 3, a / 5}));
        else if (p.kind == ParameterKind::Count)
            list.push_back(argument(graph, {std::floor(a)}));
        else if (p.kind == ParameterKind::Choice)
            list.push_back(argument(graph, {double(draw.uniform(0, 1) < 0.5)}));
        else if (p.kind ==
                 ParameterKind::Point) {  // corners of a regular polygon, for a section crosses itself nowhere
            const double turn = 2 * pi * (p.name[0] - 'a') / 12;
            list.push_back(argument(graph, {.3 * std::cos(turn), .3 * std::sin(turn)}));
        } else if (p.kind == ParameterKind::Length)
            list.push_back(
                argument(graph, {p.lo == 0 && draw.uniform(0, 1) < 0.5 ? 0 : draw.size(std::max(p.lo, 0.05), 50)}));
        else if (p.name == "bailout")
            list.push_back(argument(graph, {draw.uniform(0, 1) < 0.7 ? 0 : a}));
        else
            list.push_back(argument(graph, {a}));
    }
    return list;
}

TEST(Primitives, RowsAreWellFormed) {
    std::set<std::string_view> names;
    for (const Primitive& row : primitives()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_EQ(findPrimitive(row.name), &row);
        EXPECT_FALSE(row.doc.empty());
        for (const PrimitiveParameter& p : row.parameters) {
            EXPECT_FALSE(p.doc.empty()) << p.name;
            EXPECT_EQ(p.doc.find('\n'), std::string_view::npos);
            EXPECT_LE(p.lo, p.fallback) << p.name;
            EXPECT_GE(p.hi, p.fallback) << p.name;
            EXPECT_EQ(p.kind == ParameterKind::Choice, !p.choices.empty()) << p.name;
        }
        for (const PrimitiveJoint& j : row.joints)
            EXPECT_TRUE(length(j.facing) == 0 || std::abs(length(j.facing) - 1) < 1e-9);
    }
    EXPECT_EQ(findPrimitive("dodecahedron"), nullptr);
    for (const char* name : {"cube", "sphere", "ellipsoid", "torus", "cylinder", "cone", "pyramid", "capsule",
                             "halfspace", "roof", "kifs"})
        EXPECT_NE(findPrimitive(name), nullptr) << name;
}

TEST(Primitives, KeepTheirPromises) {
    for (const Primitive& row : primitives())
        for (uint64_t trial = 0; trial < 24; ++trial) {
            const uint64_t key = combine(hashText(row.name), trial);
            Draws draw(key);
            const double scale = draw.size(0.01, 100);
            Vec3d half{draw.size(0.2, 3) * scale, draw.size(0.2, 3) * scale, draw.size(0.2, 3) * scale};
            if (trial % 3 == 0) half = {scale, scale, scale};
            Graph graph;
            const std::vector<Argument> arguments = randomArguments(graph, row, draw);
            const Field field = build(graph, row, half, arguments, graph.position());
            std::ostringstream what;
            what << row.name << " half " << half.x << ' ' << half.y << ' ' << half.z;
            for (size_t i = 0; i < arguments.size(); ++i)
                what << ' ' << row.parameters[i].name << '=' << arguments[i].value[0];
            EXPECT_EQ(field.bounds.finite(), row.bounded) << what.str();
            // Fractals, and roofs whose own height is another than the scope's, may be nowhere near it.
            const bool fills = row.name != "kifs" && row.name != "ornament" && row.plan != PlanUse::OwnHeight;
            expectPromises(graph, field, {-half, half}, key, what.str(), fills);
        }
}

/// Sign at the centre, on both sides of each face the solid touches, and far away.
TEST(Primitives, FillTheirScope) {
    const Vec3d half{1.5, 0.8, 1.1};
    struct Touch {
        const char* name;
        std::vector<Vec3d> at;  ///< in half-sizes: points of the surface on the scope's faces
        bool hollow = false;
    };
    const Vec3d east{1, 0, 0}, west{-1, 0, 0}, top{0, 1, 0}, foot{0, -1, 0}, north{0, 0, -1}, south{0, 0, 1};
    const std::vector<Vec3d> faces{east, west, top, foot, north, south};
    const Vec3d low{0.999, -0.999, 0}, front{0, -0.999, 0.999};
    const Touch touches[] = {{"cube", faces},
                             {"sphere", faces},
                             {"ellipsoid", faces},
                             {"cylinder", faces},
                             {"capsule", {top, foot, east, west, north, south}},
                             {"cone", {top, foot, low, front}},
                             {"pyramid", {top, foot, low, front}},
                             {"prism", {top, foot, low}},
                             {"wedge", {west, foot}},
                             {"roof", {top, foot, low, front}},
                             {"torus", {{1, 0, 0}, {0, 0, 1}, {0.75, 1, 0}, {0, -1, 0.75}}, true}};
    for (const Touch& t : touches) {
        SCOPED_TRACE(t.name);
        Graph graph;
        Probe probe(graph, build(graph, t.name, half));
        for (const Vec3d& at : t.at) {
            const Vec3d core =
                t.hollow ? normalized(Vec3d{at.x, 0, at.z}) * 0.75 : Vec3d{};  // the ring's, or the middle
            EXPECT_LT(probe(((core + (at - core) * 0.97) * half).as<float>()), 0) << at.x << ' ' << at.y << ' ' << at.z;
            EXPECT_GE(probe((at * 1.01 * half).as<float>()), 0) << at.x << ' ' << at.y << ' ' << at.z;
        }
        EXPECT_GT(probe({100, 3, -20}), 50);
        EXPECT_EQ(probe({0, -0.1f, 0}) < 0, !t.hollow);
    }
}

TEST(Primitives, DistancesInClosedForm) {
    Graph graph;
    Probe cube(graph, build(graph, "cube", {1, 2, 3}));
    EXPECT_FLOAT_EQ(cube({0, 0, 0}), -1);
    EXPECT_FLOAT_EQ(cube({4, 6, 3}), 5);  // over an edge: 3-4-5
    EXPECT_FLOAT_EQ(cube({3, 4, 4}), 3);  // over a corner: 2-2-1
    Probe sphere(graph, build(graph, "sphere", {2, 2, 2}));
    EXPECT_FLOAT_EQ(sphere({3, 4, 12}), 11);
    EXPECT_FLOAT_EQ(sphere({0, 0, 0}), -2);
    Probe ellipsoid(graph, build(graph, "ellipsoid", {1, 2, 4}));
    EXPECT_FLOAT_EQ(ellipsoid({0, 4, 0}), 1);              // (|p/s| − 1) · min s
    Probe torus(graph, build(graph, "torus", {4, 1, 4}));  // R = 3, r = 1
    EXPECT_FLOAT_EQ(torus({3, 0, 0}), -1);
    EXPECT_FLOAT_EQ(torus({0, 0, 0}), 2);
    EXPECT_FLOAT_EQ(torus({6, 4, 0}), 4);
    Probe cylinder(graph, build(graph, "cylinder", {2, 3, 2}));
    EXPECT_FLOAT_EQ(cylinder({5, 7, 0}), 5);
    EXPECT_FLOAT_EQ(cylinder({0, 2.5f, 0}), -0.5f);
    Probe capsule(graph, build(graph, "capsule", {1, 3, 1}));
    EXPECT_FLOAT_EQ(capsule({0, 5, 0}), 2);
    EXPECT_FLOAT_EQ(capsule({4, 1, 0}), 3);
    Probe cone(graph, build(graph, "cone", {3, 2, 3}));  // the side is a 3-4-5 triangle
    EXPECT_FLOAT_EQ(cone({3, 2, 0}), 2.4f);
    EXPECT_FLOAT_EQ(cone({0, -1.5f, 0}), -0.5f);
    Probe pyramid(graph, build(graph, "pyramid", {3, 2, 30}));
    EXPECT_FLOAT_EQ(pyramid({1.5f + 0.8f, 0.6f, 0}), 1);  // up the normal (4, 3)/5 from the middle of a side
    Probe halfspace(graph, build(graph, "halfspace", {1, 1, 1}));
    EXPECT_EQ(halfspace({70, -3, 9}), -3);
}

TEST(Primitives, RoofIsPyramidThenEllipsoidCutAtTheFoot) {
    const Vec3d half{3, 1.2, 2};
    const Primitive& row = *findPrimitive("roof");
    Draws draw(7);
    std::vector<Vec3f> points;
    for (int i = 0; i < 2000; ++i) points.push_back(draw.in(Box3d{-half, half}.inflated(1)).as<float>());
    Graph graph;
    const auto at = [&](double round) {
        return Probe(graph, build(graph, row, half, {argument(graph, {round})}, graph.position()))(points);
    };
    const std::vector<float> sharp = at(0), between = at(0.5), dome = at(1),
                             pyramid = Probe(graph, build(graph, "pyramid", half))(points);
    for (size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(sharp[i], pyramid[i]);
        const double x = points[i].x / half.x, y = (points[i].y + half.y) / (2 * half.y), z = points[i].z / half.z;
        const double ball = x * x + y * y + z * z;
        const bool certain = std::abs(ball - 1) > 1e-4 && std::abs(y) > 1e-4;
        EXPECT_TRUE(!certain || (dome[i] < 0) == (ball < 1 && y > 0));
        EXPECT_LE(between[i], std::max(sharp[i], dome[i]) + 1e-5f);
        EXPECT_GE(between[i], std::min(sharp[i], dome[i]) - 1e-5f);
    }
}

TEST(Primitives, VolumesBySampling) {
    Graph graph;
    const auto sampled = [&](const char* name, Vec3d half) {
        return volume(graph, build(graph, name, half), {-half, half}, 60);
    };
    EXPECT_NEAR(sampled("sphere", {1, 1, 1}), 4.0 / 3 * pi, 0.01);
    EXPECT_NEAR(sampled("ellipsoid", {1, 2, 3}), 4.0 / 3 * pi * 6, 0.06);
    EXPECT_NEAR(sampled("torus", {4, 1, 4}), 2 * pi * pi * 3, 0.1);
    EXPECT_NEAR(sampled("pyramid", {1, 2, 3}), 24 * 2 / 3.0, 0.1);
    EXPECT_NEAR(sampled("cone", {1, 2, 3}), pi * 3 * 4 / 3, 0.1);
    EXPECT_NEAR(sampled("cylinder", {1, 2, 3}), pi * 3 * 4, 0.1);
    EXPECT_NEAR(sampled("capsule", {1, 3, 1}), pi * 4 + 4.0 / 3 * pi, 0.05);
    EXPECT_NEAR(sampled("prism", {1, 2, 3}), 24, 0.2);
    EXPECT_NEAR(sampled("wedge", {1, 2, 3}), 24, 0.2);
    EXPECT_NEAR(sampled("cube", {1, 2, 3}), 48, 1e-9);
}

/// Structure must not depend on numbers: the same nodes, other slot values.
TEST(Primitives, NumbersAreSlotsOnly) {
    for (const Primitive& row : primitives()) {
        // Their passes, forms and identity rotations are structure, and whether an ornament is round.
        if (row.name == "kifs" || row.name == "ornament") continue;
        // So are overhangs, boards and covers of 0, and which walls are gables.
        if (row.plan != PlanUse::None) continue;
        Graph a, b;
        Draws draw(hashText(row.name));
        build(a, row, {1, 1, 1}, randomArguments(a, row, draw), a.position());
        build(b, row, {1, 2, 3}, randomArguments(b, row, draw), b.position());
        ASSERT_EQ(a.nodeCount(), b.nodeCount()) << row.name;
        for (NodeId i = 0; i < a.nodeCount(); ++i) {
            EXPECT_EQ(a.node(i).op, b.node(i).op);
            EXPECT_EQ(a.node(i).data, b.node(i).data);
        }
    }
}

}  // namespace
}  // namespace sgm::field::test
