// Lots of both cuts, judged by CGAL's exact union.
#include <gtest/gtest.h>

#include <cmath>

#include "modeler/plan/validate.h"
#include "modeler/town/blocks.h"
#include "modeler/town/lots.h"
#include "modeler/town/skeleton.h"
#include "tests/town/arrangement.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

using plan::Footprint;
using Outlines = std::vector<std::vector<std::array<double, 2>>>;

void append(Outlines& outlines, const Lot& lot) {
    auto& outline = outlines.emplace_back();
    for (const Vec2 p : lot.land.polygons[0].outer.points) {
        const Vec2 q = lot.right * p.x + lot.front * p.z + lot.centre;
        outline.push_back({q.x, q.z});
    }
}

Footprint rectangle(double width, double depth, const std::vector<const char*>& words) {
    Footprint block = plan::footprintOf(plan::polygonOf({{0, 0}, {width, 0}, {width, depth}, {0, depth}}));
    for (size_t i = 0; i < 4; ++i) block.polygons[0].outer.edges[i].tag = block.tag(words[i]);
    return block;
}

LotParameters strips(double area_m2, double jitter = 0) {
    LotParameters p;
    p.area_m2 = area_m2, p.jitter = jitter, p.cuts = Cuts::Skeleton;
    return p;
}

TEST(Skeletons, TileTheirPolygon) {
    Footprint court = rectangle(90, 60, {"street", "street", "street", "street"});
    court.polygons[0].courts.push_back(plan::reversed(plan::ringOf({{30, 20}, {60, 20}, {60, 40}, {30, 40}})));
    for (const plan::Polygon& polygon :
         {court.polygons[0], plan::polygonOf({{0, 0}, {80, 0}, {80, 30}, {30, 30}, {30, 70}, {0, 70}})}) {
        const auto faces = skeletonFaces(polygon);
        ASSERT_EQ(faces.size(), polygon.edgeCount());
        double sum = 0;
        const auto edges = plan::edgesOf(plan::footprintOf(polygon));
        for (size_t i = 0; i < faces.size(); ++i) {
            EXPECT_EQ(faces[i][0], edges[i].from);
            EXPECT_EQ(faces[i][1], edges[i].to);
            sum += signedArea(plan::ringOf(faces[i]));
        }
        EXPECT_NEAR(sum, area(polygon), 1e-9 * area(polygon));
    }
}

TEST(SkeletonLots, StandInStripsAlongTheirStreets) {
    // 120 × 60 m between four streets: two strips of 30 m along the long ones, whose ends take the corners.
    const auto lots = lotsOf(rectangle(120, 60, {"street", "street", "street", "street"}), strips(450), 1);
    ASSERT_EQ(lots.size(), 16u);
    size_t corners = 0;
    for (const Lot& lot : lots) {
        const plan::Box2 box = bounds(lot.land);
        // At a corner the longer side is its front.
        EXPECT_NEAR(box.size().x, lot.corner ? 30 : 15, 1e-3);
        EXPECT_NEAR(box.size().z, lot.corner ? 15 : 30, 1e-3);
        EXPECT_NEAR(area(lot.land), 450, .1);
        EXPECT_NEAR(std::abs(lot.front.z), lot.corner ? 0 : 1, 1e-9);
        corners += lot.corner;
    }
    EXPECT_EQ(corners, 4u);
}

TEST(SkeletonLots, LeaveWhatLiesBehindTheirDepth) {
    LotParameters p = strips(400);
    p.depth_m = 25;
    const auto lots = lotsOf(rectangle(160, 140, {"street", "street", "street", "street"}), p, 1);
    double behind = 0, whole = 0;
    for (const Lot& lot : lots) {
        whole += area(lot.land);
        if (lot.street_m > 0)
            EXPECT_LT(area(lot.land), 800);
        else
            behind += area(lot.land);
    }
    EXPECT_NEAR(behind, 110 * 90, 1);
    EXPECT_NEAR(whole, 160 * 140, .1);
}

TEST(SkeletonLots, ReachToSidesWithoutStreet) {
    // A river behind: the strip's land goes on to it.
    const auto lots = lotsOf(rectangle(100, 30, {"street", "water", "water", "water"}), strips(300), 1);
    ASSERT_EQ(lots.size(), 10u);
    for (const Lot& lot : lots) {
        EXPECT_NEAR(lot.street_m, 10, 1e-3);
        EXPECT_NEAR(area(lot.land), 300, .2);
        EXPECT_FALSE(lot.corner);
    }
    const auto none = lotsOf(rectangle(100, 30, {"water", "water", "park", "water"}), strips(300), 1);
    ASSERT_EQ(none.size(), 1u);
    EXPECT_EQ(none[0].street_m, 0);
}

TEST(SkeletonLots, GoRoundCourtsAndNotches) {
    Footprint block = rectangle(120, 100, {"street", "street", "street", "street"});
    block.polygons[0].courts.push_back(
        plan::reversed(plan::ringOf({{50, 40}, {75, 40}, {75, 65}, {50, 65}}, {block.tag("park"), {}})));
    Footprint notched = plan::footprintOf(plan::polygonOf({{0, 0}, {90, 0}, {90, 40}, {40, 40}, {40, 90}, {0, 90}}));
    notched.tags = {"", "street"};
    for (auto& e : notched.polygons[0].outer.edges) e.tag = 1;
    for (const Footprint& land : {block, notched}) {
        const auto lots = lotsOf(land, strips(400, .2), 3);
        Outlines outlines;
        double sum = 0;
        for (const Lot& lot : lots) append(outlines, lot), sum += area(lot.land);
        EXPECT_GT(lots.size(), 10u);
        EXPECT_NEAR(sum, area(land), 1e-5 * area(land));
        EXPECT_LT(test::overlapOf(outlines), .01);
    }
}

TEST(Lots, OfBothCutsTileTheirBlocksWithoutOverlap) {
    for (const Cuts cuts : {Cuts::Boxes, Cuts::Skeleton}) {
        size_t count = 0, behind = 0, thin = 0;
        double blocks = 0, lots = 0, overlap = 0, backland = 0;
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            RoadParameters p;
            p.lo = {-450, -450}, p.hi = {450, 450};
            p.random = seed;
            p.pattern = static_cast<Pattern>(seed % 4);
            if (seed % 2) p.highwayRadius_m = 50, p.streetRadius_m = 12;
            const Land land = test::valley();
            const auto graph = growRoads(p, land);
            ASSERT_TRUE(graph.ok());
            for (const Face& face : facesOf(*graph))
                for (const Block& block : blocksOf(*graph, p, face, {land.water, land.park, 10})) {
                    LotParameters how;
                    how.area_m2 = 300 + 40 * static_cast<double>(seed), how.cuts = cuts;
                    const auto cut = lotsOf(block.land, how, block.key);
                    Outlines outlines;
                    for (const Lot& lot : cut) {
                        append(outlines, lot);
                        lots += area(lot.land);
                        ++count;
                        behind += lot.street_m == 0;
                        thin += lot.street_m > 0 && lot.street_m < how.front_m - .1 && cut.size() > 1;
                        if (lot.street_m == 0) backland += area(lot.land);
                        EXPECT_EQ(lot.land.polygons.size(), 1u);
                        EXPECT_FALSE(plan::firstFault(lot.land))
                            << plan::sentenceOf(*plan::firstFault(lot.land), lot.land);
                    }
                    blocks += area(block.land);
                    if (cut.size() == 1 || block.land.polygons[0].courts.empty()) overlap += test::overlapOf(outlines);
                }
        }
        EXPECT_GT(count, 3000u);
        EXPECT_NEAR(lots, blocks, 1e-5 * blocks);
        EXPECT_LT(overlap, 1e-6 * blocks) << (cuts == Cuts::Boxes ? "boxes" : "skeleton");
        EXPECT_LT(behind, count / 10);
        EXPECT_LT(backland, .1 * blocks);
        EXPECT_LE(thin, count / 100);
    }
}

}  // namespace
}  // namespace sgm::town
