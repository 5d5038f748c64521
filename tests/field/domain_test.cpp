#include "modeler/field/domain.h"

#include <gtest/gtest.h>

#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

TEST(Domain, ToLocalUndoesTheFrame) {
    Draws draw(1);
    for (int trial = 0; trial < 20; ++trial) {
        const Frame frame{draw.in({{-9, -9, -9}, {9, 9, 9}}), trial % 2 ? draw.rotation() : Mat3{}};
        Graph graph;
        const Point q = toLocal(graph.position(), frame, 1);
        const Vec3d local = draw.in({{-2, -2, -2}, {2, 2, 2}}), world = frame.rotation * local + frame.centre;
        EXPECT_NEAR(Probe(graph, {q.x, {}})(world.as<float>()), local.x, 1e-5);
        EXPECT_NEAR(Probe(graph, {q.y, {}})(world.as<float>()), local.y, 1e-5);
        EXPECT_NEAR(Probe(graph, {q.z, {}})(world.as<float>()), local.z, 1e-5);
        const Box3f box{{-1, -2, -0.5f}, {2, 0, 1}}, around = toWorld(box, frame);
        for (int i = 0; i < 100; ++i)
            EXPECT_TRUE(around.contains((frame.rotation * draw.in(box.as<double>()) + frame.centre).as<float>()));
    }
}

TEST(Domain, FramesAreSlotsUnderTheirPath) {
    Graph graph;
    const Frame frame{{1, 2, 3}, {}};
    toLocal(graph.position(), frame, 77);
    EXPECT_EQ(graph.constants().size(), 3u);
    EXPECT_EQ(graph.slotKeys()[0].path, 77u);
    const size_t nodes = graph.nodeCount();
    toLocal(graph.position(), {{4, 5, 6}, {}}, 77);  // the same structure with new numbers
    EXPECT_EQ(graph.nodeCount(), nodes);
    EXPECT_EQ(graph.constants()[2], 6);
}

TEST(Domain, BoxesWithoutEndsStayHonest) {
    const Box3f half{{-Box3f::limit(), -Box3f::limit(), -Box3f::limit()}, {Box3f::limit(), 0, Box3f::limit()}};
    EXPECT_NEAR(toWorld(half, {{0, 5, 0}, {}}).hi.y, 5, 1e-4);
    EXPECT_EQ(toWorld(half, {{0, 5, 0}, Mat3::rotation({1, 0, 0}, 1)}), Box3f::everything());
    EXPECT_TRUE(toWorld(Box3f{}, {{0, 5, 0}, Mat3::rotation({1, 0, 0}, 1)}).empty());
}

TEST(Domain, MirrorAndRepeatMoveCopies) {
    Graph graph;
    const Point p = graph.position();
    const auto ballAt = [&](Point q, Vec3d centre) {
        return build(graph, "sphere", {0.3, 0.3, 0.3}, toLocal(q, {centre, {}}, hashText("ball")));
    };
    Probe mirrored(graph, ballAt(mirror(p, true, false, false), {2, 0, 0}));
    EXPECT_LT(mirrored({2, 0, 0}), 0);
    EXPECT_LT(mirrored({-2, 0, 0}), 0);
    EXPECT_GT(mirrored({0, 2, 0}), 0);
    Probe endless(graph, ballAt(repeat(p, 1, graph.slot(1.5f)), {0, 0, 0}));
    for (const float y : {-6.0f, -1.5f, 0.0f, 3.0f, 150.0f}) EXPECT_FLOAT_EQ(endless({0, y, 0}), -0.3f);
    EXPECT_GT(endless({0, 0.75f, 0}), 0);
}

/// The row equals the sum of its copies near them, and ends where they end.
TEST(Domain, RepeatedEqualsTheSumOfItsCopies) {
    Graph graph;
    constexpr double period = 1.3;
    constexpr int count = 4;
    const auto ball = [&](Point p) { return build(graph, "sphere", {0.5, 0.5, 0.5}, p); };
    const Field row = repeated(graph.position(), 2, graph.slot(static_cast<float>(period)), period, count, ball);
    EXPECT_NEAR(row.bounds.hi.z, 1.5 * period + 0.5, 1e-5);
    Draws draw(2);
    Probe probe(graph, row);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d p = draw.in({{-1, -1, -4}, {1, 1, 4}});
        double least = 1e9;
        for (int j = 0; j < count; ++j) least = std::min(least, length(p - Vec3d{0, 0, (j - 1.5) * period}) - 0.5);
        const double f = probe(p.as<float>());
        EXPECT_LE(f, least + 1e-5);
        if (least < 0.6) {
            EXPECT_NEAR(f, least, 1e-5);
        }
    }
}

}  // namespace
}  // namespace sgm::field::test
