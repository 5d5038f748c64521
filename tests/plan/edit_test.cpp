// Booleans, offsets, setbacks, courts and rectifying: areas of closed forms, tags that stay, and soundness of all
// results.
#include "modeler/plan/edit.h"

#include <gtest/gtest.h>

#include "modeler/core/conventions.h"
#include "modeler/plan/formula.h"
#include "modeler/plan/shapes.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

Footprint at(Footprint f, double x, double z) { return placed(f, {1, 1}, {x, z}); }

/// A rectangle whose sides carry the tags back, right, front, left.
Footprint tagged(double width, double depth) {
    Footprint f = *rectangle(width, depth);
    for (const char* word : {"back", "right", "front", "left"}) {
        const uint32_t tag = f.tag(word);
        f.polygons[0].outer.edges[tag - 1].tag = tag;
    }
    return f;
}

std::string tagAt(const Footprint& f, Vec2 p) {
    for (const PlacedEdge& e : edgesOf(f)) {
        const Vec2 d = e.to - e.from;
        const double t = dot(p - e.from, d) / dot(d, d);
        if (t > 0 && t < 1 && std::abs(cross(d, p - e.from)) / length(d) < 1e-3) return f.tags[e.edge.tag];
    }
    return "no edge";
}

void expectSound(const Footprint& f, const std::string& what = "") {
    if (f.empty()) return;
    const auto fault = firstFault(f);
    EXPECT_FALSE(fault) << what << sentenceOf(*fault, f);
}

TEST(Edit, BooleansOfRectangles) {
    const Footprint a = tagged(10, 6), b = at(*rectangle(4, 10), 2, 0);
    const Footprint sum = boolean(Boolean::Union, a, b), left = boolean(Boolean::Difference, a, b),
                    both = boolean(Boolean::Intersection, a, b);
    EXPECT_NEAR(area(sum), 60 + 40 - 24, 1e-5);
    EXPECT_NEAR(area(left), 36, 1e-5);
    EXPECT_EQ(left.polygons.size(), 2u);
    EXPECT_NEAR(area(both), 24, 1e-5);
    EXPECT_EQ(sum.edgeCount(), 12u);
    EXPECT_EQ(tagAt(sum, {-3, -3}), "back");
    EXPECT_EQ(tagAt(left, {-5, 1}), "left");
    for (const PlacedEdge& e : edgesOf(left))
        EXPECT_EQ(e.edge.source == EdgeSource::Cut, std::abs(e.normal().x) > .5 && std::abs(e.from.x) < 4.5);
    EXPECT_NEAR(area(boolean(Boolean::Difference, a, at(*rectangle(2, 2), 0, 0))), 56, 1e-5);
    EXPECT_TRUE(boolean(Boolean::Intersection, a, at(*rectangle(1, 1), 50, 0)).empty());
}

/// A comb of `teeth` as long as all of them are wide together; turned, they run along x.
Footprint comb(int teeth, bool isTurned) {
    std::vector<Vec2> points;
    const double side = 2 * teeth;
    for (int i = 0; i < teeth; ++i)
        for (const Vec2 p : {Vec2{2.0 * i, i ? 1. : 0}, Vec2{2.0 * i, side}, Vec2{2 * i + 1.0, side},
                             Vec2{2 * i + 1.0, i + 1 < teeth ? 1. : 0}})
            points.push_back(isTurned ? Vec2{p.z - .25, p.x + .25} : p);
    return footprintOf(polygonOf(std::move(points)));
}

TEST(Edit, BooleansOfOutlinesThatCrossTooOftenHaveABudget) {
    const Footprint a = comb(40, false), b = comb(40, true);
    expectSound(a), expectSound(b);
    const auto fine = booleanInBudget(Boolean::Union, a, b);
    ASSERT_TRUE(fine.ok()) << fine.error().message;
    EXPECT_EQ(*fine, boolean(Boolean::Union, a, b));
    EXPECT_TRUE(shareArea(a, b, 1));
    EXPECT_FALSE(shareArea(a, b, 1e5));
    const Footprint many = comb(1000, false), others = comb(1000, true);
    const auto refused = booleanInBudget(Boolean::Difference, many, others);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().kind, Error::Kind::Budget);
    EXPECT_NE(refused.error().message.find("cross each other more than 20000 times"), std::string::npos);
    EXPECT_TRUE(shareArea(many, others, 1e-6));
    EXPECT_TRUE(booleanInBudget(Boolean::Union, many, at(*rectangle(4, 4), 0, 0)).ok()) << "many points, few crossings";
}

TEST(Edit, SetbacksOfManyEdgesOverOthersHaveABudget) {
    const Footprint few = comb(20, false), many = comb(300, false);
    const std::vector<double> narrow(few.edgeCount(), .2), wide(many.edgeCount(), 100), thin(many.edgeCount(), .2);
    const auto fine = setbackInBudget(few, narrow);
    ASSERT_TRUE(fine.ok()) << fine.error().message;
    EXPECT_EQ(*fine, setback(few, narrow));
    EXPECT_TRUE(setbackInBudget(many, thin).ok()) << "many edges, none over another";
    const auto refused = setbackInBudget(many, wide);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().kind, Error::Kind::Budget);
}

TEST(Edit, ChurchPlansOfUnionsAreOneOutline) {
    const Footprint nave = boolean(Boolean::Union, *rectangle(12, 40), at(*rectangle(26, 10), 0, 7));
    Footprint apse = at(*round(24, 6), 0, 20);
    const uint32_t tag = apse.tag("apse");
    for (Edge& e : apse.polygons[0].outer.edges) e.tag = tag;
    const Footprint church = boolean(Boolean::Union, nave, apse);
    EXPECT_EQ(church.polygons.size(), 1u);
    expectSound(church);
    EXPECT_EQ(tagAt(church, {0, 20 + 6 * std::sqrt(2 * pi / 24 / std::sin(2 * pi / 24)) * std::cos(pi / 24)}), "apse");
}

TEST(Edit, OffsetsHaveMitredCornersAndKeepTags) {
    const Footprint f = tagged(10, 6);
    EXPECT_NEAR(area(offset(f, 1)), 12 * 8, 1e-5);
    EXPECT_NEAR(area(offset(f, -1)), 8 * 4, 1e-5);
    EXPECT_TRUE(offset(f, -3.1).empty());
    EXPECT_EQ(tagAt(offset(f, -1), {0, 2}), "front");
    EXPECT_EQ(tagAt(offset(f, 1), {0, 4}), "front");
    EXPECT_NEAR(area(offset(*ring(20, 16, 4), -1)), 18 * 14 - 14 * 10, 1e-5);
    EXPECT_EQ(offset(*yard(20, 15, 4), 10).polygons[0].outer.size(), 4u);
    EXPECT_NEAR(area(rim(f, 1)), 60 - 32, 1e-5);
    EXPECT_EQ(offset(f, 0), f);
}

TEST(Edit, FallingApartStaysOneFootprint) {
    // Two rooms joined by a passage of 1 m.
    const Footprint f = boolean(Boolean::Union, boolean(Boolean::Union, *rectangle(20, 1), at(*rectangle(6, 6), -9, 0)),
                                at(*rectangle(6, 6), 9, 0));
    const Footprint in = offset(f, -.6);
    EXPECT_EQ(in.polygons.size(), 2u);
    EXPECT_NEAR(area(in), 2 * 4.8 * 4.8, 1e-4);
}

TEST(Edit, SetbacksByTheEdge) {
    const Footprint f = tagged(10, 6);
    const double in[] = {1, 0, 2, .5};  // back, right, front, left
    const Footprint back = setback(f, in);
    EXPECT_NEAR(area(back), 9.5 * 3, 1e-5);
    EXPECT_EQ(tagAt(back, {0, 1}), "front");
    EXPECT_EQ(tagAt(back, {5, 0}), "right");
    expectSound(back);
    EXPECT_TRUE(setback(f, std::vector<double>{4, 0, 4, 0}).empty());
    // What lies beyond a gap stays: two arms, the upper one's right half set back by more than both.
    const Footprint arms =
        footprintOf(polygonOf({{0, 0}, {10, 0}, {10, 1}, {1, 1}, {1, 2}, {10, 2}, {10, 3}, {5, 3}, {0, 3}}));
    std::vector<double> only(9);
    only[6] = 2.5;
    EXPECT_NEAR(area(setback(arms, only)), 21 - 5, 1e-4);
}

TEST(Edit, EqualSetbacksAreOffsets) {
    for (uint64_t key = 0; key < 200; ++key) {
        const Footprint f = test::anyPlan(key);
        const double by = .2;
        const Footprint a = setback(f, std::vector<double>(f.edgeCount(), by)), b = offset(f, -by);
        expectSound(a, std::to_string(key));
        expectSound(b, std::to_string(key));
        // Where corners are so sharp that the mitre is cut, the two cut it differently.
        EXPECT_NEAR(area(a), area(b), .02 * area(f) + .05) << key;
    }
}

TEST(Edit, CourtsLeaveWings) {
    const Footprint f = *court(tagged(20, 14), 4);
    EXPECT_NEAR(area(f), 20 * 14 - 12 * 6, 1e-4);
    ASSERT_EQ(f.polygons[0].courts.size(), 1u);
    for (const Edge& e : f.polygons[0].courts[0].edges) {
        EXPECT_EQ(e.source, EdgeSource::Court);
        EXPECT_EQ(f.tags[e.tag], "court");
    }
    EXPECT_EQ(tagAt(f, {0, 7}), "front");
    EXPECT_FALSE(court(*rectangle(5, 5), 3));
    EXPECT_FALSE(court(*rectangle(5, 5), 0));
}

TEST(Edit, CrossingOutlinesAreResolvedByWinding) {
    const Footprint bow = footprintOf({ringOf({{0, 0}, {4, 4}, {4, 0}, {0, 4}}), {}});
    const auto two = resolved(bow);
    ASSERT_TRUE(two.ok());
    EXPECT_NEAR(area(*two), 8, 1e-2);
    expectSound(*two);
    // A turtle that goes round twice, and one that hangs together in a corner.
    std::vector<Vec2> twice;
    for (int i = 0; i < 10; ++i) twice.push_back({5 * std::cos(4 * pi * i / 5), 5 * std::sin(4 * pi * i / 5)});
    EXPECT_TRUE(resolved(footprintOf({ringOf(twice), {}})).ok());
    EXPECT_FALSE(resolved(footprintOf({ringOf({{0, 0}, {std::nan(""), 1}, {1, 1}}), {}})).ok());
    for (uint64_t key = 0; key < 300; ++key) {
        test::Draws draw(key);
        std::vector<Vec2> walk{{0, 0}};
        for (int i = 0, way = 0; i < 60; ++i) {
            way += draw.whole(-1, 1);
            walk.push_back(walk.back() + Vec2{std::cos(way * pi / 2), std::sin(way * pi / 2)});
        }
        const auto f = resolved(footprintOf({ringOf(walk), {}}));
        ASSERT_TRUE(f.ok());
        expectSound(*f, std::to_string(key));
        if (!f->empty()) {
            EXPECT_TRUE(monotoneFormula(*f).ok());
        }
    }
}

TEST(Edit, SurveyedPlansAreRectified) {
    test::Draws draw(3);
    for (int i = 0; i < 50; ++i) {
        const Footprint exact = test::rectilinear(draw, 6, draw.whole(3, 12));
        Footprint surveyed = turned(exact, draw.real(0, 1));
        for (Polygon& p : surveyed.polygons)
            for (Vec2& v : p.outer.points) v = v + Vec2{draw.real(-.03, .03), draw.real(-.03, .03)};
        if (firstFault(surveyed)) continue;
        const Footprint f = rectified(surveyed, radians(10));
        expectSound(f);
        const auto edges = edgesOf(f);
        for (size_t k = 0; k + 1 < edges.size(); ++k) {
            if (edges[k].ring != edges[k + 1].ring) continue;
            const Vec2 a = edges[k].normal(), b = edges[k + 1].normal();
            EXPECT_LT(std::min(std::abs(dot(a, b)), std::abs(cross(a, b))), 1e-5);
        }
        EXPECT_NEAR(area(f), area(exact), .05 * perimeter(exact));
    }
}

TEST(Edit, InnerRectangles) {
    const Box2 square = *innerRectangle(*rectangle(7, 3));
    EXPECT_NEAR(square.size().x, 7, 1e-9);
    EXPECT_NEAR(square.size().z, 3, 1e-9);
    const Box2 bar = *innerRectangle(*ell(16, 14, 6, 5));
    EXPECT_NEAR(bar.size().x * bar.size().z, 16 * 6, 1e-6);
    const Box2 round_ = *innerRectangle(*round(64, 5));
    EXPECT_NEAR(round_.size().x * round_.size().z, 50, 1.2);
    for (uint64_t key = 0; key < 100; ++key) {
        const Footprint f = test::anyPlan(key);
        const auto box = innerRectangle(f);
        ASSERT_TRUE(box.has_value());
        test::Draws draw(key);
        for (int i = 0; i < 50; ++i)
            EXPECT_TRUE(contains(
                f, {draw.real(box->lo.x + 1e-9, box->hi.x - 1e-9), draw.real(box->lo.z + 1e-9, box->hi.z - 1e-9)}))
                << key;
    }
    EXPECT_FALSE(innerRectangle(Footprint{}).has_value());
}

TEST(Edit, RandomBooleansAreSoundAndKeepArea) {
    for (uint64_t key = 0; key < 300; ++key) {
        const Footprint a = test::anyPlan(key), b = test::anyPlan(key + 1000);
        const Footprint sum = boolean(Boolean::Union, a, b), both = boolean(Boolean::Intersection, a, b),
                        left = boolean(Boolean::Difference, a, b);
        for (const Footprint* f : {&sum, &both, &left}) expectSound(*f, std::to_string(key));
        // Where rings touch, all is .2 mm smaller.
        const double within = .02 + 5e-4 * (perimeter(a) + perimeter(b));
        EXPECT_NEAR(area(sum) + area(both), area(a) + area(b), within) << key;
        EXPECT_NEAR(area(left) + area(both), area(a), within) << key;
    }
}

}  // namespace
}  // namespace sgm::plan
