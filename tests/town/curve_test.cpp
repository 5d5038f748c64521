#include "modeler/town/curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "modeler/plan/edit.h"
#include "modeler/town/blocks.h"
#include "modeler/town/faces.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

RoadParameters rounded(uint64_t seed) {
    RoadParameters p;
    p.lo = {-600, -600}, p.hi = {600, 600};
    p.random = seed;
    p.turn = .25;
    p.pattern = static_cast<Pattern>(seed % 4);
    p.highwayRadius_m = 60, p.streetRadius_m = 15;
    return p;
}

/// The nodes of every curve, in the order of its edges.
std::map<uint32_t, std::vector<uint32_t>> curvesOf(const RoadGraph& graph) {
    std::map<uint32_t, std::vector<uint32_t>> curves;
    for (const RoadEdge& e : graph.edges()) {
        if (!e.curve) continue;
        auto& nodes = curves[e.curve];
        if (nodes.empty()) nodes.push_back(e.a);
        EXPECT_EQ(nodes.back(), e.a);
        nodes.push_back(e.b);
    }
    return curves;
}

/// Of the circle through three points.
double radiusThrough(Vec2 a, Vec2 b, Vec2 c) {
    return length(b - a) * length(c - b) * length(c - a) / (2 * std::abs(cross(b - a, c - a)));
}

TEST(Curves, AreArcsOfTheLeastRadiusOrMore) {
    size_t curves = 0, corners = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        const RoadParameters p = rounded(seed);
        const auto graph = growRoads(p, test::valley());
        ASSERT_TRUE(graph.ok());
        for (const auto& [number, nodes] : curvesOf(*graph)) {
            ++curves;
            const uint32_t first = graph->nodes()[nodes[0]].edges[0];
            const double least = graph->edge(first).kind == RoadClass::Highway ? 60 : 15;
            for (size_t i = 2; i < nodes.size(); ++i) {
                const Vec2 a = graph->metresAt(nodes[i - 2]), b = graph->metresAt(nodes[i - 1]),
                           c = graph->metresAt(nodes[i]);
                // The lattice is 1 mm: a flat arc's radius isn't told any better by short chords.
                EXPECT_GT(radiusThrough(a, b, c), least * .97);
                const double r = radiusThrough(a, b, c), half = length(b - a) / 2;
                EXPECT_LT(r - std::sqrt(r * r - half * half), .21);
            }
        }
        for (uint32_t n = 0; n < graph->nodes().size(); ++n) {
            if (graph->degree(n) != 2) continue;
            const auto& e = graph->nodes()[n].edges;
            const double bend = -dot(unit(graph->along(e[0], n)), unit(graph->along(e[1], n)));
            corners += bend < .9 && graph->edge(e[0]).kind == graph->edge(e[1]).kind && !graph->edge(e[0]).bridge &&
                       !graph->edge(e[1]).bridge;
        }
    }
    EXPECT_GT(curves, 300u);
    EXPECT_LT(corners, curves / 10);
}

TEST(Curves, TouchTheirRoadsAndNothingElse) {
    RoadGraph graph;
    const uint32_t a = graph.addNode({0, 0}), n = graph.addNode({100'000, 0}), b = graph.addNode({100'000, 80'000});
    graph.addEdge(a, n, RoadClass::Street, false);
    graph.addEdge(n, b, RoadClass::Street, false);
    RoadParameters p = rounded(1);
    RoadGraph wide = graph, blocked = graph, narrow = graph;
    curveBends(wide, p, {});
    wide.compact();
    const auto curves = curvesOf(wide);
    ASSERT_EQ(curves.size(), 1u);
    const auto& nodes = curves.begin()->second;
    EXPECT_EQ(wide.at(nodes.front()), (Point{61'600, 0}));  // 48 % of the shorter piece
    EXPECT_EQ(wide.at(nodes.back()), (Point{100'000, 38'400}));
    for (const uint32_t k : nodes) EXPECT_NEAR(length(wide.metresAt(k) - Vec2{61.6, 38.4}), 38.4, 2e-3);
    // A road across the corner's inside, 30 m from it: a tighter curve goes round it.
    const uint32_t c = blocked.addNode({95'000, 3'000}), d = blocked.addNode({60'000, 60'000});
    blocked.addEdge(c, d, RoadClass::Street, false);
    curveBends(blocked, p, {});
    blocked.compact();
    for (const auto& [number, line] : curvesOf(blocked))
        for (size_t i = 1; i < line.size(); ++i)
            EXPECT_FALSE(segmentsMeet(blocked.at(line[i - 1]), blocked.at(line[i]), {95'000, 3'000}, {60'000, 60'000}));
    // No room for the least radius: the corner stays.
    p.streetRadius_m = 60;
    curveBends(narrow, p, {});
    EXPECT_TRUE(curvesOf(narrow).empty());
    EXPECT_EQ(narrow.edges().size(), 2u);
}

TEST(Curves, KeepOutOfParksAndWater) {
    RoadGraph graph;
    const uint32_t a = graph.addNode({0, 0}), n = graph.addNode({100'000, 0}), b = graph.addNode({100'000, 100'000});
    graph.addEdge(a, n, RoadClass::Street, false);
    graph.addEdge(n, b, RoadClass::Street, false);
    Land land;
    land.park = [](Vec2 p) { return length(p - Vec2{70, 30}) < 27; };
    curveBends(graph, rounded(1), land);
    for (const RoadEdge& e : graph.edges())
        if (!e.removed && e.curve) {
            EXPECT_FALSE(land.park(graph.metresAt(e.a)));
            EXPECT_FALSE(land.park(graph.metresAt(e.b)));
        }
    EXPECT_FALSE(curvesOf(graph).empty());
}

TEST(Curves, AreFollowedBySurfacesAndBlocks) {
    const Land land = test::valley();
    RoadParameters p = rounded(5);
    const auto graph = growRoads(p, land);
    ASSERT_TRUE(graph.ok());
    const auto surfaces = surfacesOf(*graph, p);
    const auto curves = curvesOf(*graph);
    size_t bands = 0;
    for (const RoadSurface& s : surfaces) {
        if (s.edge == noIndex || !graph->edge(s.edge).curve) continue;
        ++bands;
        const auto& nodes = curves.at(graph->edge(s.edge).curve);
        double along = 0;
        for (size_t i = 1; i < nodes.size(); ++i)
            along += length(graph->metresAt(nodes[i]) - graph->metresAt(nodes[i - 1]));
        EXPECT_NEAR(area(s.area), along * p.width_m(graph->edge(s.edge).kind), 2);
    }
    EXPECT_EQ(bands, curves.size());
    EXPECT_GT(bands, 20u);
    double shared = 0;
    for (const Face& face : facesOf(*graph))
        for (const Block& block : blocksOf(*graph, p, face, {land.water, land.park, 10}))
            for (const RoadSurface& s : surfaces) {
                const plan::Box2 a = bounds(block.land), b = bounds(s.area);
                if (a.hi.x < b.lo.x || b.hi.x < a.lo.x || a.hi.z < b.lo.z || b.hi.z < a.lo.z) continue;
                shared += area(plan::boolean(plan::Boolean::Intersection, block.land, s.area));
            }
    EXPECT_LT(shared, 1);
}

}  // namespace
}  // namespace sgm::town
