// The ground of a town: what roads, water and buildings make of heights.
#include "modeler/town/terrain.h"

#include <gtest/gtest.h>

#include "tests/town/maps.h"

namespace sgm::town {
namespace {

RoadParameters onHills() {
    RoadParameters p;
    p.lo = {-500, -500}, p.hi = {500, 500};
    p.street_m = 10, p.highway_m = 16, p.junction = 4;
    return p;
}

double rolling(Vec2 p) {
    return 30 * test::hill(p, {-250, 200}, 300) + 18 * test::hill(p, {260, -240}, 260) + .02 * p.x;
}

Terrain surveyed(const RoadParameters& p, const Land& land) {
    auto terrain = Terrain::survey(p, land, nullptr);
    EXPECT_TRUE(terrain.ok()) << terrain.error().message;
    return std::move(*terrain);
}

struct Hills {
    RoadParameters parameters = onHills();
    Land land = test::valley();
    Terrain terrain;
    RoadGraph graph;
    explicit Hills(uint64_t seed = 1, double scale = 1) {
        parameters.random = seed;
        land.height = [scale](Vec2 p) { return scale * rolling(p); };
        terrain = surveyed(parameters, land);
        land.height = [this](Vec2 p) { return terrain.naturalAt(p); };
        auto grown = growRoads(parameters, land);
        EXPECT_TRUE(grown.ok());
        graph = std::move(*grown);
        terrain.grade(graph);
    }
};

/// The steepest rise between neighbours of a lattice where `counts`.
double steepest(const HeightMap& map, const std::function<bool(Vec2)>& counts) {
    double most = 0;
    const auto at = [&](int i, int k) {
        return static_cast<double>(map.heights[static_cast<size_t>(k * map.columns + i)]);
    };
    for (int k = 0; k + 1 < map.rows; ++k)
        for (int i = 0; i + 1 < map.columns; ++i) {
            if (!counts(map.low + Vec2{i * map.cell_m, k * map.cell_m})) continue;
            most = std::max({most, std::abs(at(i + 1, k) - at(i, k)), std::abs(at(i, k + 1) - at(i, k))});
        }
    return most / map.cell_m;
}

TEST(Terrain, NoRoadIsSteeperThanAllowed) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        Hills hills(seed);
        ASSERT_GT(hills.graph.edges().size(), 60u);
        for (const RoadEdge& e : hills.graph.edges()) {
            const double rise = hills.terrain.nodeHeights()[e.b] - hills.terrain.nodeHeights()[e.a];
            EXPECT_LE(std::abs(rise),
                      hills.parameters.slope * length(hills.graph.metresAt(e.b) - hills.graph.metresAt(e.a)) + .002);
        }
        EXPECT_LE(hills.terrain.steepest().slope, hills.parameters.slope + 1e-4);
    }
}

TEST(Terrain, GroundFollowsTheMiddleOfItsRoads) {
    Hills hills;
    hills.terrain.finish();
    const HeightMap& ground = hills.terrain.layers().ground;
    double off = 0;
    size_t count = 0;
    for (const RoadEdge& e : hills.graph.edges()) {
        if (e.bridge) continue;
        const Vec2 a = hills.graph.metresAt(e.a), b = hills.graph.metresAt(e.b),
                   side{-(b - a).z / length(b - a), (b - a).x / length(b - a)};
        const double middle = (hills.terrain.nodeHeights()[e.a] + hills.terrain.nodeHeights()[e.b]) / 2;
        for (const double out : {-4.0, 0.0, 4.0}) {
            off = std::max(off, std::abs(ground.at((a + b) * .5 + side * out) - middle));
            ++count;
        }
    }
    EXPECT_GT(count, 180u);
    EXPECT_LT(off, .35);  // roads that run side by side share corners
}

/// One road through a hill: level across, with banks that are as steep as they may be and no steeper.
TEST(Terrain, CutsAndFillsWithBanks) {
    RoadParameters p = onHills();
    p.bank = .5;
    Land land;
    land.height = [](Vec2 q) { return 25 * test::hill(q, {0, 0}, 120); };
    Terrain terrain = surveyed(p, land);
    RoadGraph graph;
    const uint32_t a = graph.addNode({-200'000, 0}), b = graph.addNode({200'000, 0});
    graph.addEdge(a, b, RoadClass::Street, false);
    terrain.grade(graph);
    terrain.finish();
    const HeightMap& ground = terrain.layers().ground;
    for (double x = -190; x <= 190; x += 10)
        for (const double z : {-5.0, 0.0, 5.0}) EXPECT_NEAR(ground.at({x, z}), 0, 1e-3);
    EXPECT_NEAR(ground.at({0, 25}), .5 * (25 - 5 - 1.42 * 2.5), 1.5);
    EXPECT_NEAR(ground.at({0, 100}), land.height({0, 100}), .1);
    EXPECT_LE(steepest(ground, [](Vec2) { return true; }), .5 * 1.001);
}

TEST(Terrain, LevelsTheGroundBelowBuildings) {
    Hills hills;
    const Vec2 at{-120, 180};
    const size_t area =
        hills.terrain.level(plan::footprintOf(plan::polygonOf({{-130, 172}, {-110, 172}, {-110, 188}, {-130, 188}})));
    hills.terrain.finish();
    const HeightMap& ground = hills.terrain.layers().ground;
    for (const Vec2 off : {Vec2{0, 0}, Vec2{-10, -8}, Vec2{10, 8}, Vec2{10, -8}, Vec2{3, 7}})
        EXPECT_NEAR(ground.at(at + off), hills.terrain.levelOf(area), 1e-4);
    EXPECT_NEAR(hills.terrain.levelOf(area), rolling(at), 3);
}

TEST(Terrain, WaterLiesInABedAndFallsByLittle) {
    RoadParameters p = onHills();
    Land land;
    land.height = [](Vec2 q) { return .04 * q.x + 6 * std::sin(q.x / 40) + .1 * std::abs(q.z); };
    land.water = [](Vec2 q) { return std::abs(q.z) < 20; };
    Terrain terrain = surveyed(p, land);
    terrain.finish();
    const TerrainLayers& layers = terrain.layers();
    for (double x = -480; x < 470; x += 7) {
        EXPECT_NEAR(layers.ground.at({x, 0}), layers.water.at({x, 0}) - p.bed_m, 1e-3);
        EXPECT_LE(layers.water.at({x, 0}), land.height({x, 0}) + .01);
        EXPECT_LE(std::abs(layers.water.at({x + 10, 0}) - layers.water.at({x, 0})), .06);
    }
    EXPECT_LE(steepest(layers.ground, [](Vec2 q) { return std::abs(q.z) > 25; }), p.bank * 1.001);
}

/// A lake on a hill stays up there although another one lies below.
TEST(Terrain, LakesHaveHeightsOfTheirOwn) {
    RoadParameters p = onHills();
    Land land;
    land.height = [](Vec2 q) { return q.x < 0 ? 0 : std::min(40.0, q.x * .8); };
    land.water = [](Vec2 q) { return length(q - Vec2{-200, 0}) < 60 || length(q - Vec2{250, 0}) < 60; };
    Terrain terrain = surveyed(p, land);
    terrain.finish();
    EXPECT_NEAR(terrain.layers().water.at({-200, 0}), 0, .01);
    EXPECT_NEAR(terrain.layers().water.at({250, 0}), 40, .01);
}

TEST(Terrain, BridgesClearTheWater) {
    size_t bridges = 0;
    for (const uint64_t seed : {1, 2, 3}) {
        Hills hills(seed);
        hills.terrain.finish();
        const TerrainLayers& layers = hills.terrain.layers();
        for (const RoadEdge& e : hills.graph.edges()) {
            if (!e.bridge) continue;
            const Vec2 a = hills.graph.metresAt(e.a), b = hills.graph.metresAt(e.b);
            for (double t = .05; t < 1; t += .1) {
                const Vec2 q = a + (b - a) * t;
                if (hills.land.water(q)) {
                    EXPECT_GT(layers.deck.at(q), layers.water.at(q) + 2.5);
                    ++bridges;
                }
                EXPECT_NEAR(layers.deck.at(q),
                            hills.terrain.nodeHeights()[e.a] +
                                t * (hills.terrain.nodeHeights()[e.b] - hills.terrain.nodeHeights()[e.a]),
                            .2);
            }
        }
    }
    EXPECT_GT(bridges, 10u);
}

TEST(Terrain, IsTheSameEachTime) {
    Hills a(2), b(2);
    a.terrain.finish(), b.terrain.finish();
    EXPECT_EQ(a.terrain.layers().ground.heights, b.terrain.layers().ground.heights);
    EXPECT_EQ(a.terrain.layers().deck.heights, b.terrain.layers().deck.heights);
}

TEST(Terrain, RefusesHeightsThatAreNone) {
    Land land;
    land.height = [](Vec2 p) { return p.x > 100 ? 1e9 : 0; };
    const auto terrain = Terrain::survey(onHills(), land, nullptr);
    ASSERT_FALSE(terrain.ok());
    EXPECT_NE(terrain.error().message.find("heights are at most 100 km"), std::string::npos);
}

}  // namespace
}  // namespace sgm::town
