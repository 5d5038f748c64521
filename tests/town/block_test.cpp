#include <gtest/gtest.h>

#include <set>

#include "modeler/core/random.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/read.h"
#include "modeler/town/blocks.h"
#include "modeler/town/lots.h"
#include "modeler/town/outline.h"
#include "modeler/town/town_plan.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

using plan::Footprint;

struct Town {
    RoadParameters parameters;
    Land land = test::valley();
    RoadGraph graph;
    std::vector<Block> blocks;
    explicit Town(uint64_t seed, Ends ends = Ends::Prune) {
        parameters.lo = {-500, -500}, parameters.hi = {500, 500};
        parameters.random = seed;
        parameters.junction = 3 + static_cast<double>(seed % 5);
        parameters.ends = ends;
        parameters.pattern = static_cast<Pattern>(seed % 3);
        auto grown = growRoads(parameters, land);
        EXPECT_TRUE(grown.ok());
        if (grown.ok()) graph = std::move(*grown);
        for (const Face& face : facesOf(graph))
            for (Block& block : blocksOf(graph, parameters, face, {land.water, land.park, 10}))
                blocks.push_back(std::move(block));
    }
};

Vec2 randomPlace(uint64_t key) { return {uniform(combine(key, 1), -500, 500), uniform(combine(key, 2), -500, 500)}; }

TEST(Blocks, AndRoadsShareNoGround) {
    for (uint64_t seed = 1; seed <= 9; ++seed) {
        const Town town(seed, seed % 2 ? Ends::Prune : Ends::Keep);
        const auto surfaces = surfacesOf(town.graph, town.parameters);
        size_t built = 0, roads = 0, both = 0, twice = 0, wet = 0;
        for (uint64_t i = 0; i < 3000; ++i) {
            const Vec2 p = randomPlace(combine(seed, i));
            size_t in = 0, on = 0;
            for (const Block& block : town.blocks) in += contains(block.land, p) && distanceToEdges(block.land, p) > .1;
            for (const RoadSurface& s : surfaces) on += contains(s.area, p) && distanceToEdges(s.area, p) > .1;
            built += in, roads += on > 0, both += in > 0 && on > 0, twice += in > 1;
            if (in && (town.land.water(p) || town.land.park(p))) wet += 1;
        }
        EXPECT_EQ(both, 0u);
        EXPECT_EQ(twice, 0u);
        EXPECT_LE(wet, 3u);  // outlines follow their lattice
        EXPECT_GT(built, 800u);
        EXPECT_GT(roads, 200u);
    }
}

TEST(Blocks, TellTheirSides) {
    const Town town(3);
    std::set<std::string> words;
    for (const Block& block : town.blocks)
        for (const plan::PlacedEdge& e : plan::edgesOf(block.land)) words.insert(block.land.tags[e.edge.tag]);
    for (const char* word : {"street", "street highway", "water"}) EXPECT_TRUE(words.contains(word)) << word;
    EXPECT_FALSE(words.contains(""));
}

TEST(Lots, TileTheirBlockAndHaveAStreet) {
    size_t count = 0, behind = 0;
    std::set<uint64_t> keys;
    for (uint64_t seed = 1; seed <= 9; ++seed) {
        const Town town(seed);
        for (const Block& block : town.blocks) {
            const LotParameters parameters{300 + 50 * static_cast<double>(seed), 8, .15};
            const auto lots = lotsOf(block.land, parameters, block.key);
            double sum = 0;
            for (const Lot& lot : lots) {
                ++count;
                sum += area(lot.land);
                keys.insert(combine(seed, lot.key));
                behind += lot.street_m == 0;
                EXPECT_TRUE(lots.size() == 1 || lot.street_m == 0 || lot.street_m > 7.9) << lot.street_m;
                EXPECT_NEAR(length(lot.right), 1, 1e-9);
                EXPECT_NEAR(dot(lot.right, lot.front), 0, 1e-9);
                EXPECT_LT(length(bounds(lot.land).centre()), 1e-6);
            }
            EXPECT_NEAR(sum, area(block.land), 1e-5 * area(block.land) + .02);
        }
    }
    EXPECT_EQ(keys.size(), count);
    EXPECT_GT(count, 3000u);
    EXPECT_LT(behind, count / 10);
}

Footprint inBlock(const Lot& lot) {
    Footprint out = lot.land;
    const auto place = [&](plan::Ring& ring) {
        for (Vec2& p : ring.points) p = lot.right * p.x + lot.front * p.z + lot.centre;
    };
    for (plan::Polygon& polygon : out.polygons) {
        place(polygon.outer);
        for (plan::Ring& court : polygon.courts) place(court);
    }
    return out;
}

TEST(Lots, DontOverlap) {
    const Town town(4);
    double shared = 0;
    for (const Block& block : town.blocks) {
        const auto lots = lotsOf(block.land, {}, block.key);
        for (size_t i = 0; i < lots.size(); ++i)
            for (size_t k = i + 1; k < lots.size(); ++k) {
                if (length(lots[i].centre - lots[k].centre) > 120) continue;
                shared += area(plan::boolean(plan::Boolean::Intersection, inBlock(lots[i]), inBlock(lots[k])));
            }
    }
    EXPECT_LT(shared, .05);
}

TEST(Lots, LookAtTheirStreet) {
    // A block of 100 × 40 m with one street, at its −z side: lots stand side by side, z towards the street.
    Footprint block = plan::footprintOf(plan::polygonOf({{0, 0}, {100, 0}, {100, 40}, {0, 40}}));
    block.polygons[0].outer.edges[0].tag = block.tag("street");
    const auto lots = lotsOf(block, {500, 8, 0}, 1);
    ASSERT_EQ(lots.size(), 8u);
    for (const Lot& lot : lots) {
        EXPECT_NEAR(lot.front.z, -1, 1e-9);
        EXPECT_NEAR(bounds(lot.land).size().x, 12.5, 1e-6);
        EXPECT_NEAR(bounds(lot.land).size().z, 40, 1e-6);
        EXPECT_NEAR(lot.street_m, 12.5, 1e-6);
        EXPECT_FALSE(lot.corner);
    }
    block.polygons[0].outer.edges[1].tag = block.tag("street highway");
    size_t corners = 0;
    for (const Lot& lot : lotsOf(block, {500, 8, 0}, 1)) corners += lot.corner;
    EXPECT_EQ(corners, 1u);
}

TEST(Outlines, FollowTheirFormula) {
    const auto ring = [](Vec2 p) { return length(p) < 90 && length(p) > 40; };
    const Footprint found = outlineOf(ring, {-100, -100}, {100, 100}, 10, "water");
    ASSERT_EQ(found.polygons.size(), 1u);
    EXPECT_EQ(found.polygons[0].courts.size(), 1u);
    EXPECT_NEAR(area(found), 3.14159 * (8100 - 1600), 400);
    const auto all = [](Vec2) { return true; };
    EXPECT_NEAR(area(outlineOf(all, {-30, -30}, {50, 50}, 10, "")), 6400, 1e-6);
    EXPECT_TRUE(outlineOf([](Vec2) { return false; }, {-30, -30}, {50, 50}, 10, "").empty());
    // Corners that touch: either way the outline is sound.
    const auto checkers = [](Vec2 p) {
        return (std::floor(p.x / 20) + std::floor(p.z / 20)) / 2 ==
               std::floor((std::floor(p.x / 20) + std::floor(p.z / 20)) / 2);
    };
    EXPECT_NEAR(area(outlineOf(checkers, {-100, -100}, {100, 100}, 10, "")), 20000, 2500);
}

TEST(Outlines, OfNeighboursAskALatticePointOnce) {
    size_t asked = 0;
    const std::function<bool(Vec2)> disc = [&](Vec2 p) { return ++asked, length(p - Vec2{7, 3}) < 63; };
    const auto once = remembered(disc, {-100, -100}, {100, 100}, 10);
    const Footprint expected = outlineOf(disc, {-60, -100}, {100, 100}, 10, "water");
    const size_t alone = asked;
    EXPECT_EQ(outlineOf(once, {-60, -100}, {100, 100}, 10, "water"), expected);
    const size_t first = asked - alone;
    EXPECT_EQ(first, alone);
    EXPECT_EQ(outlineOf(once, {-60, -100}, {100, 100}, 10, "water"), expected);
    EXPECT_LT(asked - alone - first, first - 17 * 21 + 1);  // bisections alone
    EXPECT_EQ(once({250, 0}), false);                       // beyond the rectangle
    EXPECT_FALSE(remembered({}, {-1, -1}, {1, 1}, 1));
}

TEST(TownPlan, CanBeReadBack) {
    TownPlan plan;
    const Town town(5);
    for (const Block& block : town.blocks) plan.features.push_back({"block", block.land, block.key, 0});
    std::string json, drawing;
    writeGeoJson(plan, [&](std::string_view piece) { json += piece; });
    writeSvg(plan, [&](std::string_view piece) { drawing += piece; });
    const auto back = plan::readGeoJson(json);
    ASSERT_TRUE(back.ok()) << back.error().message;
    ASSERT_EQ(back->list.size(), town.blocks.size());
    for (size_t i = 0; i < town.blocks.size(); ++i)
        EXPECT_NEAR(area(back->list[i].footprint), area(town.blocks[i].land), .5);
    const auto svg = plan::readSvg(drawing);
    ASSERT_TRUE(svg.ok()) << svg.error().message;
    EXPECT_EQ(svg->list.size(), town.blocks.size());
}

}  // namespace
}  // namespace sgm::town
