// The interpolated field of a sampled grid: inside the grid, beyond it, and what it promises.
#include "tests/field/sampled.h"

#include "modeler/field/ops.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

/// The grid's own frame.
Field bare(Graph& graph, const SampledGridPtr& grid) {
    return {graph.apply(codeOf<ops::Sampled>, {graph.x(), graph.y(), graph.z()}, graph.grid(grid)), grid->bounds(),
            grid->lipschitz(), 0.7f};
}

double torus(Vec3f p) { return std::hypot(std::hypot(double{p.x}, double{p.y}) - 1, double{p.z}) - 0.4; }

TEST(Sampled, IsTheDistanceToSecondOrderAndNoMoreBeyond) {
    double worst[2];
    for (const int fine : {0, 1}) {
        Graph graph;
        const SampledGridPtr grid = sampledTorus(fine ? 32 : 16);
        Probe probe(graph, bare(graph, grid));
        Draws draw(5);
        worst[fine] = 0;
        for (int i = 0; i < 3000; ++i) {
            const double around = draw.uniform(0, 6.28), along = draw.uniform(0, 6.28), r = draw.uniform(0.3, 0.43);
            const double out = 1 + r * std::cos(along);
            const Vec3f p = Vec3d{out * std::cos(around), out * std::sin(around), r * std::sin(along)}.as<float>();
            worst[fine] = std::max(worst[fine], std::abs(probe(p) - torus(p)));
        }
        for (int i = 0; i < 3000; ++i) {
            const Vec3f p = draw.in({{-9, -9, -9}, {9, 9, 9}}).as<float>();
            EXPECT_LE(probe(p), torus(p) + 0.02);
            EXPECT_GE(probe(p), std::min(0.0, torus(p)) + 0.7 * distance(grid->bounds(), p) - 0.02);
        }
    }
    EXPECT_LT(worst[1], 2e-3);
    EXPECT_LT(worst[1], worst[0] / 3);
}

TEST(Sampled, KeepsItsPromises) {
    for (const int perMetre : {3, 8, 20}) {
        Graph graph;
        const Field field = bare(graph, sampledTorus(perMetre));
        EXPECT_LT(field.lipschitz, 1.8f);
        expectPromises(graph, field, field.bounds.as<double>(), 11, std::to_string(perMetre));
    }
}

/// A ramp is interpolated exactly, so its slope is the bound.
TEST(Sampled, LipschitzConstantIsTheSteepestSlope) {
    std::vector<float> ramp;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) ramp.push_back(static_cast<float>(3 * i + 4 * j) * 0.5f + 1);
    const SampledGrid grid({0, 0, 0}, 0.5f, {4, 4, 4}, ramp, {{0, 0, 0}, {1, 1, 1}});
    EXPECT_NEAR(grid.lipschitz(), 5, 1e-2);
    std::vector<float> flat(64, 2.0f);
    EXPECT_EQ(SampledGrid({0, 0, 0}, 0.5f, {4, 4, 4}, flat, {{0, 0, 0}, {1, 1, 1}}).lipschitz(), 1)
        << "beyond the grid";
}

TEST(Sampled, AGraphNumbersEachGridOnce) {
    Graph graph;
    const SampledGridPtr a = sampledTorus(4), b = sampledTorus(5);
    EXPECT_EQ(graph.grid(a), 0u);
    EXPECT_EQ(graph.grid(b), 1u);
    EXPECT_EQ(graph.grid(a), 0u);
    EXPECT_NE(a->hash(), b->hash());
    EXPECT_EQ(a->hash(), sampledTorus(4)->hash());
    const NodeRef one = bare(graph, a).value, same = bare(graph, a).value, other = bare(graph, b).value;
    EXPECT_EQ(one.id(), same.id());
    EXPECT_NE(one.id(), other.id());
}

}  // namespace
}  // namespace sgm::field::test
