// Plates and core sum to the footprint and don't overlap; bands along lines.
#include "modeler/plan/plates.h"

#include <gtest/gtest.h>

#include "modeler/plan/edit.h"
#include "modeler/plan/shapes.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

double sumOf(const Plates& plates) {
    double sum = area(plates.core);
    for (const Plate& plate : plates.plates) sum += area(plate.footprint);
    return sum;
}

TEST(Plates, OfShapesAreTrapezoids) {
    for (const auto& f :
         {*rectangle(10, 6), *ell(16, 14, 6, 5), *ring(20, 16, 4), *ngon(6, 5), *arc(11, 16, .2, 2.1, 12)}) {
        const Plates plates = *platesOf(f, .3);
        ASSERT_EQ(plates.plates.size(), f.edgeCount());
        EXPECT_NEAR(sumOf(plates), area(f), 1e-9);
        EXPECT_NEAR(area(plates.core), area(offset(f, -.3)), 1e-3);
        const auto edges = edgesOf(f);
        for (const Plate& plate : plates.plates) {
            EXPECT_FALSE(firstFault(plate.footprint));
            const Ring& ring = plate.footprint.polygons[0].outer;
            EXPECT_EQ(ring.size(), 4u);
            EXPECT_EQ(ring.from(0), edges[plate.edge].from);
            EXPECT_EQ(ring.edges[0], edges[plate.edge].edge);
            EXPECT_EQ(ring.edges[1].source, EdgeSource::Cut);
        }
    }
}

TEST(Plates, OfRandomPlansSumToTheWhole) {
    size_t cutInTurn = 0;
    for (uint64_t key = 0; key < 150; ++key) {
        test::Draws draw(key);
        const Footprint f = test::anyPlan(key);
        if (f.edgeCount() > 120) continue;
        const auto plates = platesOf(f, draw.real(.05, 1.5));
        ASSERT_TRUE(plates.ok());
        EXPECT_NEAR(sumOf(*plates), area(f), .002 * area(f) + .02) << key;
        cutInTurn += plates->plates.size() < f.edgeCount() || plates->core.edgeCount() < f.edgeCount();
        for (const Plate& plate : plates->plates) EXPECT_FALSE(firstFault(plate.footprint)) << key;
        if (!plates->core.empty()) {
            EXPECT_FALSE(firstFault(plates->core)) << key;
        }
        // Nothing twice.
        const Box2 box = bounds(f);
        for (int i = 0; i < 60; ++i) {
            const Vec2 p{draw.real(box.lo.x, box.hi.x), draw.real(box.lo.z, box.hi.z)};
            int inside = !plates->core.empty() && contains(plates->core, p);
            for (const Plate& plate : plates->plates) inside += contains(plate.footprint, p);
            EXPECT_LE(inside, contains(f, p) ? 1 : 0) << key;
        }
    }
    EXPECT_GT(cutInTurn, 20u);
    EXPECT_FALSE(platesOf(*rectangle(3, 3), 0).ok());
    EXPECT_TRUE(platesOf(*rectangle(3, 3), 2)->core.empty());
}

TEST(Plates, BandsHaveMitredCornersAndTheirSegmentsTags) {
    Ring path = ringOf({{0, 0}, {4, 0}, {4, 3}});
    path.edges[0].tag = 1, path.edges[1].tag = 2;
    const Footprint open = *band(path, {"", "a", "b"}, .2, false);
    EXPECT_NEAR(area(open), .2 * 7, 1e-4);
    EXPECT_EQ(open.edgeCount(), 6u);
    int first = 0, second = 0;
    for (const PlacedEdge& e : edgesOf(open)) first += e.edge.tag == 1, second += e.edge.tag == 2;
    EXPECT_GE(first, 2);
    EXPECT_GE(second, 2);
    const Footprint closed = *band(ringOf({{0, 0}, {4, 0}, {4, 3}, {0, 3}}), {""}, .2, true);
    EXPECT_NEAR(area(closed), 4.2 * 3.2 - 3.8 * 2.8, 1e-4);
    EXPECT_EQ(closed.polygons[0].courts.size(), 1u);
    const Footprint crossing = *band(ringOf({{0, 0}, {4, 4}, {4, 0}, {0, 4}}), {""}, .2, false);
    EXPECT_FALSE(firstFault(crossing));
    EXPECT_FALSE(band(ringOf({{0, 0}}), {""}, .2, false).ok());
    EXPECT_FALSE(band(ringOf({{0, 0}, {std::nan(""), 0}}), {""}, .2, false).ok());
    EXPECT_FALSE(band(ringOf({{0, 0}, {1, 0}}), {""}, 0, false).ok());
}

}  // namespace
}  // namespace sgm::plan
