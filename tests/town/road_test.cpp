#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "modeler/plan/lattice.h"
#include "modeler/town/faces.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

using test::hill;

RoadParameters smallTown(uint64_t seed, Pattern pattern = Pattern::Grown) {
    RoadParameters p;
    p.lo = {-500, -500}, p.hi = {500, 500};
    p.random = seed;
    p.pattern = pattern;
    p.turn = .05 + .01 * static_cast<double>(seed % 9);
    p.junction = 3 + static_cast<double>(seed % 5);
    p.turns = static_cast<Turns>(seed % 3);
    p.axis = .1 * static_cast<double>(seed % 16);
    return p;
}

RoadGraph grown(const RoadParameters& p, const Land& land) {
    auto graph = growRoads(p, land);
    EXPECT_TRUE(graph.ok()) << graph.error().message;
    return graph.ok() ? std::move(*graph) : RoadGraph{};
}

plan::LatticePoint wide(Point p) { return {p.x, p.z}; }

/// Whether two edges share a point that is no common node, by the exact predicates of modeler/plan.
bool overlap(const RoadGraph& graph, const RoadEdge& e, const RoadEdge& f) {
    const auto a = wide(graph.at(e.a)), b = wide(graph.at(e.b)), c = wide(graph.at(f.a)), d = wide(graph.at(f.b));
    if (e.a != f.a && e.a != f.b && e.b != f.a && e.b != f.b) return plan::meet(a, b, c, d);
    const bool atA = e.a == f.a || e.a == f.b;
    const auto shared = atA ? a : b, own = atA ? b : a, other = (f.a == e.a || f.a == e.b) ? d : c;
    return plan::turn(shared, own, other) == 0 && plan::wideDot(own - shared, other - shared) > 0;
}

size_t crossings(const RoadGraph& graph) {
    size_t count = 0;
    for (size_t i = 0; i < graph.edges().size(); ++i)
        for (size_t k = i + 1; k < graph.edges().size(); ++k)
            count += overlap(graph, graph.edges()[i], graph.edges()[k]);
    return count;
}

size_t components(const RoadGraph& graph) {
    std::vector<uint32_t> root(graph.nodes().size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t n) {
        while (root[n] != n) n = root[n] = root[root[n]];
        return n;
    };
    for (const RoadEdge& e : graph.edges()) root[find(e.a)] = find(e.b);
    size_t count = 0;
    for (uint32_t n = 0; n < root.size(); ++n) count += find(n) == n;
    return count;
}

double lengthOf(const RoadGraph& graph, const RoadEdge& e) { return length(graph.metresAt(e.b) - graph.metresAt(e.a)); }

TEST(Roads, AreAPlanarConnectedGraphWithoutDeadEnds) {
    const Land land = test::valley();
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        const RoadGraph graph = grown(smallTown(seed, static_cast<Pattern>(seed % 3)), land);
        ASSERT_GT(graph.edges().size(), 50u);
        EXPECT_EQ(crossings(graph), 0u);
        EXPECT_EQ(components(graph), 1u);
        // Euler: V − E + F = 1 + C with the unbounded face.
        const auto v = static_cast<int64_t>(graph.nodes().size()), e = static_cast<int64_t>(graph.edges().size());
        EXPECT_EQ(v - e + static_cast<int64_t>(facesOf(graph).size()) + 1, 2);
        for (uint32_t n = 0; n < graph.nodes().size(); ++n) EXPECT_GE(graph.degree(n), 2u);
    }
}

TEST(Roads, KeepTheirAnglesAndLengths) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const RoadParameters p = smallTown(seed);
        const RoadGraph graph = grown(p, test::valley());
        for (const RoadEdge& e : graph.edges()) EXPECT_GT(lengthOf(graph, e), 7.9);
        for (uint32_t n = 0; n < graph.nodes().size(); ++n)
            for (const uint32_t e : graph.nodes()[n].edges)
                for (const uint32_t f : graph.nodes()[n].edges) {
                    const double c = std::max(-1.0, dot(unit(graph.along(e, n)), unit(graph.along(f, n))));
                    EXPECT_TRUE(e == f || std::acos(c) > p.angle - 1e-3) << c;
                }
    }
}

TEST(Roads, CrossWaterByBridgesAloneAndEnterNoPark) {
    const Land land = test::valley();
    size_t bridges = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const RoadParameters p = smallTown(seed);
        const RoadGraph graph = grown(p, land);
        for (const RoadEdge& e : graph.edges()) {
            bridges += e.bridge;
            EXPECT_TRUE(!e.bridge || lengthOf(graph, e) <= p.bridge_m + 31);
            const Vec2 a = graph.metresAt(e.a), d = graph.metresAt(e.b) - a;
            // Roads ask the maps every 5 m: nothing longer than that is missed.
            double wet = 0, green = 0, mostWet = 0, mostGreen = 0;
            for (double t = 0; t <= 1; t += 1 / 256.0) {
                wet = land.water(a + d * t) ? wet + length(d) / 256 : 0, mostWet = std::max(mostWet, wet);
                green = land.park(a + d * t) ? green + length(d) / 256 : 0, mostGreen = std::max(mostGreen, green);
            }
            EXPECT_LT(mostGreen, 5.8);
            EXPECT_TRUE(e.bridge || mostWet < 5.8) << mostWet;
        }
    }
    EXPECT_GT(bridges, 20u);
    RoadParameters none = smallTown(3);
    none.bridge_m = 0;
    const RoadGraph graph = grown(none, land);
    for (const RoadEdge& e : graph.edges()) EXPECT_FALSE(e.bridge);
}

TEST(Roads, AreNoSteeperThanAllowed) {
    Land land;
    land.height = [](Vec2 p) { return 120 * hill(p, {200, 0}, 400); };
    RoadParameters p = smallTown(5);
    p.slope = .1;
    const RoadGraph graph = grown(p, land);
    size_t high = 0;
    for (const RoadEdge& e : graph.edges()) {
        const double a = land.height(graph.metresAt(e.a)), b = land.height(graph.metresAt(e.b));
        // Splits may lie off the straight line between two heights.
        EXPECT_LE(std::abs(a - b), .16 * lengthOf(graph, e));
        high += std::max(a, b) > 60;
    }
    p.slope = 10;
    size_t highFree = 0;
    const RoadGraph free = grown(p, land);
    for (const RoadEdge& e : free.edges()) highFree += land.height(free.metresAt(e.a)) > 60;
    EXPECT_LT(high, highFree);
}

std::set<std::pair<Point, Point>> placesOf(const RoadGraph& graph, Vec2 from, double away_m) {
    std::set<std::pair<Point, Point>> out;
    for (const RoadEdge& e : graph.edges()) {
        if (length(graph.metresAt(e.a) - from) < away_m || length(graph.metresAt(e.b) - from) < away_m) continue;
        out.insert(std::minmax(graph.at(e.a), graph.at(e.b)));
    }
    return out;
}

TEST(Roads, AreTheSameAgainAndFarFromAChange) {
    RoadParameters p = smallTown(7);
    p.lo = {-1500, -1500}, p.hi = {1500, 1500};
    p.ends = Ends::Keep;
    Land land = test::valley();
    land.spread = nullptr;
    const RoadGraph first = grown(p, land);
    const auto all = placesOf(first, {}, 0);
    EXPECT_EQ(all, placesOf(grown(p, land), {}, 0));
    const Vec2 corner{1200, -1200};
    Land moved = land;
    moved.park = [&](Vec2 q) { return land.park(q) || length(q - corner) < 150; };
    const auto before = placesOf(first, corner, 1500), after = placesOf(grown(p, moved), corner, 1500);
    size_t kept = 0;
    for (const auto& e : before) kept += after.contains(e);
    EXPECT_GE(kept, before.size() * 95 / 100);
    EXPECT_GT(before.size(), 500u);
    EXPECT_NE(all, placesOf(grown(p, moved), {}, 0));
}

TEST(Roads, FarFromAMovedParkStayAsTheyWere) {
    // As a town is planned: dead ends pruned, curves rounded, every pattern.
    for (const Pattern pattern : {Pattern::Grown, Pattern::Raster, Pattern::Radial, Pattern::Field}) {
        RoadParameters p = smallTown(7, pattern);
        p.lo = {-1500, -1500}, p.hi = {1500, 1500};
        p.from = p.centre = Vec2{-200, -150};
        p.highwayRadius_m = 80, p.streetRadius_m = 12;
        Land land = test::valley();
        land.spread = nullptr;
        land.shore = land.grid = [](Vec2) { return 1.; };
        const Vec2 corner{1200, -1200}, beside{1000, -1100};
        const auto withPark = [&](Vec2 at) {
            Land moved = land;
            moved.park = [&land, at](Vec2 q) { return land.park(q) || length(q - at) < 150; };
            return grown(p, moved);
        };
        const RoadGraph before = withPark(corner), after = withPark(beside);
        const auto far = placesOf(before, corner, 1500), again = placesOf(after, corner, 1500);
        size_t kept = 0;
        for (const auto& e : far) kept += again.contains(e);
        EXPECT_GE(kept, far.size() * 95 / 100) << static_cast<int>(pattern);
        EXPECT_GT(far.size(), 500u);
        EXPECT_NE(placesOf(before, {}, 0), placesOf(after, {}, 0));
    }
}

TEST(Roads, PatternsLayThemAlongTheirAxes) {
    for (const Pattern pattern : {Pattern::Raster, Pattern::Radial}) {
        RoadParameters p = smallTown(4, pattern);
        p.axis = .4;
        p.centre = Vec2{0, 0};
        p.from = Vec2{0, 0};
        double along = 0, whole = 0;
        const RoadGraph graph = grown(p, {});
        for (const RoadEdge& e : graph.edges()) {
            const Vec2 d = unit(graph.metresAt(e.b) - graph.metresAt(e.a));
            const Vec2 middle = unit(graph.metresAt(e.a) + graph.metresAt(e.b));
            const Vec2 axis = pattern == Pattern::Raster ? directionAt(p.axis) : middle;
            const double c = std::abs(dot(d, axis)), s = std::abs(cross(d, axis));
            whole += lengthOf(graph, e);
            if (std::min(c, s) < .2) along += lengthOf(graph, e);
        }
        EXPECT_GT(along, .75 * whole);
    }
}

TEST(Roads, EndsAreKeptJoinedOrPruned) {
    RoadParameters p = smallTown(2);
    size_t open[3] = {}, edges[3] = {};
    for (const Ends ends : {Ends::Prune, Ends::Join, Ends::Keep}) {
        p.ends = ends;
        const RoadGraph graph = grown(p, test::valley());
        const auto index = static_cast<size_t>(ends);
        for (uint32_t n = 0; n < graph.nodes().size(); ++n) open[index] += graph.degree(n) == 1;
        edges[index] = graph.edges().size();
        EXPECT_EQ(crossings(graph), 0u);
        EXPECT_EQ(components(graph), 1u);
    }
    EXPECT_EQ(open[0], 0u);
    EXPECT_EQ(open[1], 0u);
    EXPECT_GT(open[2], 3u);
    EXPECT_GT(edges[1], edges[0]);
}

TEST(Roads, SayWhyNoneCanGrow) {
    Land sea;
    sea.water = [](Vec2) { return true; };
    EXPECT_EQ(growRoads(smallTown(1), sea).error().kind, Error::Kind::Input);
    RoadParameters p = smallTown(1);
    p.from = Vec2{9000, 0};
    EXPECT_EQ(growRoads(p, {}).error().kind, Error::Kind::Input);
    p = smallTown(1);
    p.limit = 100;
    EXPECT_EQ(growRoads(p, {}).error().kind, Error::Kind::Budget);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(growRoads(smallTown(1), {}, &progress).error().kind, Error::Kind::Cancelled);
}

TEST(Roads, DirectionsAreUnitVectors) {
    for (double a = -20; a < 20; a += .01) {
        const Vec2 d = directionAt(a);
        EXPECT_NEAR(d.x, std::cos(a), 1e-12);
        EXPECT_NEAR(d.z, std::sin(a), 1e-12);
    }
}

/// A square of 300 m with what is added to it.
struct Square {
    RoadGraph graph;
    uint32_t corner[4];
    Square() {
        const Point at[4] = {{0, 0}, {300000, 0}, {300000, 300000}, {0, 300000}};
        for (int i = 0; i < 4; ++i) corner[i] = graph.addNode(at[i]);
        for (int i = 0; i < 4; ++i) graph.addEdge(corner[i], corner[(i + 1) % 4], RoadClass::Street, false);
    }
};

TEST(Faces, PartAtSpursAndAtNodes) {
    Square square;
    RoadGraph& g = square.graph;
    EXPECT_EQ(facesOf(g).size(), 1u);
    // A spur from a corner that ends in a triangle, whose inside is a face of its own.
    const uint32_t a = g.addNode({100000, 100000}), b = g.addNode({150000, 100000}), c = g.addNode({100000, 150000});
    const uint32_t spur = g.addEdge(square.corner[0], a, RoadClass::Street, false);
    g.addEdge(a, b, RoadClass::Street, false);
    g.addEdge(b, c, RoadClass::Street, false);
    g.addEdge(c, a, RoadClass::Street, false);
    // A triangle that touches a corner of the square from inside.
    const uint32_t d = g.addNode({250000, 260000}), e = g.addNode({260000, 250000});
    g.addEdge(square.corner[2], d, RoadClass::Street, false);
    g.addEdge(d, e, RoadClass::Street, false);
    g.addEdge(e, square.corner[2], RoadClass::Street, false);
    const auto faces = facesOf(g);
    ASSERT_EQ(faces.size(), 3u);
    size_t whole = 0;
    for (const Face& face : faces) {
        if (face.outline.size() == 3) continue;
        ++whole;
        EXPECT_EQ(face.outline.size(), 4u);
        EXPECT_EQ(face.holes.size(), 2u);
        EXPECT_EQ(face.spurs, std::vector<uint32_t>{spur});
    }
    EXPECT_EQ(whole, 1u);
}

}  // namespace
}  // namespace sgm::town
