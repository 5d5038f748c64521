// What is found of rings without booleans is what booleans and offsets find.
#include <gtest/gtest.h>

#include "modeler/plan/cut.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/ring_parts.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan::test {
namespace {

/// The plan without its courts.
Ring outlineOf(uint64_t key) { return anyPlan(key).polygons[0].outer; }

/// What lies in one of both alone, m².
double difference(const Footprint& a, const Footprint& b) {
    return area(boolean(Boolean::Difference, a, b)) + area(boolean(Boolean::Difference, b, a));
}

Footprint footprintOfRing(Ring ring) {
    Footprint out;
    if (ring.size() >= 3) out.polygons.push_back({std::move(ring), {}});
    return out;
}

TEST(RingParts, SidesOfACutAreThoseOfBooleans) {
    int once = 0, reflex = 0;
    for (uint64_t key = 0; key < 1500; ++key) {
        const Ring ring = outlineOf(key);
        const Footprint whole = footprintOfRing(ring);
        Draws draw(combine(key, 99));
        const Box2 box = bounds(ring);
        const double angle = draw.real(0, 6.28);
        const Vec2 n{std::cos(angle), std::sin(angle)};
        // Every third line runs through a corner, every third along an edge.
        const size_t corner = static_cast<size_t>(draw.whole(0, static_cast<int>(ring.size()) - 1));
        const Vec2 d = ring.to(corner) - ring.from(corner);
        const Vec2 normal = key % 3 == 2 ? Vec2{d.z, -d.x} * (1 / std::hypot(d.x, d.z)) : n;
        const Vec2 on =
            key % 3 == 0 ? Vec2{draw.real(box.lo.x, box.hi.x), draw.real(box.lo.z, box.hi.z)} : ring.points[corner];
        const double at = dot(normal, on);
        if (!isCutOnce(ring, normal, at)) continue;
        ++once;
        reflex += !isConvex(ring);
        const Footprint below = footprintOfRing(partBelow(ring, normal, at)),
                        above = footprintOfRing(partBelow(ring, normal * -1, -at));
        EXPECT_NEAR(area(below) + area(above), area(whole), 1e-3 * std::sqrt(area(whole))) << key;
        // A rectangle that reaches beyond the plan stands for the half-plane.
        const Vec2 along{-normal.z, normal.x}, foot = box.centre() + normal * (at - dot(normal, box.centre()));
        const Footprint half =
            footprintOf(polygonOf({foot - along * 300, foot + along * 300, foot + along * 300 - normal * 300,
                                   foot - along * 300 - normal * 300}));
        EXPECT_LT(difference(below, boolean(Boolean::Intersection, whole, half)), 2e-3 * perimeter(whole.polygons[0]))
            << key;
        for (const Footprint* part : {&below, &above})
            if (area(*part) > 1e-3) {
                EXPECT_FALSE(firstFault(*part)) << key << ": " << sentenceOf(*firstFault(*part), *part);
            }
    }
    EXPECT_GT(once, 400);
    EXPECT_GT(reflex, 150);
}

/// An edge along the line, and a corner that touches it, belong to the general way.
TEST(RingParts, LinesAlongEdgesOfReflexRingsAreLeftToBooleans) {
    const Ring ell = polygonOf({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}).outer;
    EXPECT_FALSE(isCutOnce(ell, {0, 1}, 2));
    EXPECT_FALSE(isCutOnce(ell, {0, 1}, 2.001));
    EXPECT_TRUE(isCutOnce(ell, {0, 1}, 1));
    const Footprint above = clipped(footprintOf(polygonOf(ell.points)), {{0, -1}, -2});
    EXPECT_FALSE(firstFault(above));
    EXPECT_NEAR(area(above), 4, 1e-6);
    const Ring notched = polygonOf({{0, 0}, {6, 0}, {6, 4}, {4, 4}, {3, 1}, {2, 4}, {0, 4}}).outer;
    EXPECT_FALSE(isCutOnce(notched, {0, 1}, 3));  // four crossings
    EXPECT_FALSE(isCutOnce(notched, {0, 1}, 1));
}

TEST(RingParts, EqualDistancesMoveRingsAsOffsetsDo) {
    int convex = 0, reflex = 0;
    for (uint64_t key = 0; key < 1500; ++key) {
        const Ring ring = outlineOf(key);
        Draws draw(combine(key, 77));
        const double by = draw.real(.05, 1.5);
        const auto moved = movedIn(ring, std::vector<double>(ring.size(), by));
        if (!moved) continue;
        ++(isConvex(ring) ? convex : reflex);
        const Footprint expected = offset(footprintOfRing(ring), -by);
        EXPECT_LT(difference(footprintOfRing(*moved), expected), 2e-3 * perimeter(footprintOfRing(ring))) << key;
    }
    EXPECT_GT(convex, 50);
    EXPECT_GT(reflex, 100);
}

TEST(RingParts, EdgesInLineHaveNoCornerBetweenUnequalDistances) {
    const Ring ring = polygonOf({{0, 0}, {5, 0}, {10, 0}, {10, 8}, {0, 8}}).outer;
    EXPECT_FALSE(movedIn(ring, std::vector<double>{3, 1, 1, 1, 1}));
    const auto equal = movedIn(ring, std::vector<double>{1, 1, 2, 1, 2});
    ASSERT_TRUE(equal);
    EXPECT_NEAR(signedArea(*equal), 6 * 6, 1e-9);
    // A step is left there: booleans have it.
    const std::vector<double> unequal{3, 1, 0, 0, 0};
    EXPECT_NEAR(area(setback(footprintOfRing(ring), unequal)), 80 - 15 - 5, 1e-4);
}

}  // namespace
}  // namespace sgm::plan::test
