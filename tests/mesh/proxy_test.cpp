// Proxies: closed, coarse, around their solids, and no farther off than asked.
#include <gtest/gtest.h>

#include <cmath>

#include "modeler/field/combine.h"
#include "modeler/mesh/proxy.h"
#include "modeler/mesh/validate.h"

namespace sgm::mesh {
namespace {

/// Two balls of radius 1, their centres at x = ±0.8, as noisy as asked.
field::Field twoBalls(field::Graph& g, double noise_m) {
    const auto ball = [&](float x) {
        field::Field f{length(field::Point{g.x() - x, g.y(), g.z()}) - 1.0f, {{x - 1, -1, -1}, {x + 1, 1, 1}}};
        return field::Owned{f, 0};
    };
    const field::Owned balls[] = {ball(-0.8f), ball(0.8f)};
    const field::Field f = field::sum(g, balls);
    if (noise_m == 0) return f;
    return field::displace(f, g.position(), field::Noise::Billow, g.slot(static_cast<float>(noise_m)), noise_m,
                           g.slot(2.0f), 2, 2, 7);
}

TEST(Proxy, EnclosesWithinItsTolerance) {
    for (const double tolerance_m : {0.2, 0.5}) {
        field::Graph graph;
        const field::Field solid = twoBalls(graph, 0);
        const auto made = proxy(graph, solid, tolerance_m, 2, nullptr);
        ASSERT_TRUE(made.ok());
        const MeshFigures figures = measure(*made);
        EXPECT_EQ(figures.boundaryEdges, 0u);
        EXPECT_EQ(figures.nonmanifoldEdges, 0u);
        EXPECT_EQ(figures.components, 1u);
        EXPECT_GT(figures.volume_m3, 8.15);  // the balls hold 8π/3 less their lens of 0.23 m³
        EXPECT_TRUE(encloses(*made, eval::compile(graph, solid, graph.constants())));
        for (const Chunk& c : made->chunks)
            for (const Vec3f& p : c.positions) {
                const float off = std::min(length(p - Vec3f{-0.8f, 0, 0}), length(p - Vec3f{0.8f, 0, 0})) - 1;
                EXPECT_GT(off, 0);
                EXPECT_LT(off, static_cast<float>(tolerance_m));
            }
    }
}

TEST(Proxy, IsCoarse) {
    field::Graph graph;
    const field::Field solid = twoBalls(graph, 0.1);
    const auto fine = proxy(graph, solid, 0.25, 2, nullptr), coarse = proxy(graph, solid, 0.5, 2, nullptr);
    ASSERT_TRUE(fine.ok() && coarse.ok());
    EXPECT_LT(coarse->triangleCount(), 600u);
    EXPECT_LT(coarse->triangleCount(), fine->triangleCount());
    EXPECT_TRUE(encloses(*coarse, eval::compile(graph, solid, graph.constants())));
}

TEST(Proxy, ASmallerMeshDoesNotEnclose) {
    field::Graph graph;
    const field::Field solid = twoBalls(graph, 0);
    auto made = proxy(graph, solid, 0.3, 2, nullptr);
    ASSERT_TRUE(made.ok());
    for (Chunk& c : made->chunks)
        for (Vec3f& p : c.positions) p = p * 0.8f;
    EXPECT_FALSE(encloses(*made, eval::compile(graph, solid, graph.constants())));
}

TEST(Proxy, RefusesWhatItCannotBound) {
    field::Graph graph;
    field::Field solid = twoBalls(graph, 0);
    EXPECT_EQ(proxy(graph, solid, 0, 2, nullptr).error().kind, Error::Kind::Usage);
    solid.lipschitz = std::numeric_limits<float>::infinity();
    EXPECT_EQ(proxy(graph, solid, 0.1, 2, nullptr).error().kind, Error::Kind::Input);
}

}  // namespace
}  // namespace sgm::mesh
