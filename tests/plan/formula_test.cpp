// The monotone formula: signs against point-in-polygon, each edge once, and what it is a bound of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "modeler/plan/formula.h"
#include "modeler/plan/shapes.h"
#include "tests/cpu_time.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

using test::Draws;

/// Plans to try: a few thousand, or as many as SGM_PLANS says.
int plansToTry() {
    const char* const wanted = std::getenv("SGM_PLANS");
    return wanted ? std::atoi(wanted) : 4000;
}

/// Points anywhere, near edges and near corners, farther than `least` from every edge.
std::vector<Vec2> samples(const Footprint& f, Draws& draw, int count, double least) {
    const Box2 box = bounds(f);
    const auto edges = edgesOf(f);
    std::vector<Vec2> points;
    for (int i = 0; i < count; ++i) {
        Vec2 p{draw.real(box.lo.x - 1, box.hi.x + 1), draw.real(box.lo.z - 1, box.hi.z + 1)};
        if (i % 2) {
            const PlacedEdge& e = edges[static_cast<size_t>(draw.whole(0, static_cast<int>(edges.size()) - 1))];
            const double t = i % 4 == 1 ? 0 : draw.real(0, 1), off = std::pow(10, draw.real(-4, 0));
            p = e.from + (e.to - e.from) * t + Vec2{draw.real(-off, off), draw.real(-off, off)};
        }
        if (distanceToEdges(f, p) > least) points.push_back(p);
    }
    return points;
}

void expectSigns(const Footprint& f, Draws& draw, int count, const std::string& what) {
    const auto formula = monotoneFormula(f);
    ASSERT_TRUE(formula.ok()) << what << formula.error().message;
    const auto leaves = distancesOf(f);
    std::vector<int> uses(leaves.size());
    for (const FormulaNode& node : formula->nodes)
        if (node.kind == FormulaNode::Kind::Edge) ++uses[node.first];
    for (const int n : uses) ASSERT_EQ(n, 1) << what;
    ASSERT_EQ(formula->nodes.size(), 2 * leaves.size() - 1);
    for (const Vec2 p : samples(f, draw, count, 1e-6)) {
        const double value = valueOf(*formula, leaves, p), away = distanceToEdges(f, p);
        ASSERT_EQ(value < 0, contains(f, p)) << what << " at " << p.x << ' ' << p.z << ": " << value;
        ASSERT_LE(std::abs(value), away + 1e-9) << what;
    }
}

TEST(Formula, SignsOfRandomPlansAreThoseOfThePolygon) {
    for (int i = 0; i < plansToTry(); ++i) {
        Draws draw(combine(hashText("signs"), static_cast<uint64_t>(i)));
        expectSigns(test::anyPlan(static_cast<uint64_t>(i)), draw, 60, "plan " + std::to_string(i));
        if (HasFatalFailure()) return;
    }
}

TEST(Formula, StraightCornersAndLevelRaysDoNoHarm) {
    // Collinear runs, teeth level with each other, and all of it turned by quarters.
    std::vector<std::vector<Vec2>> outlines{
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},
        {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},
        {{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {3, 2}, {3, 3}, {0, 3}, {0, 2}, {1, 2}, {1, 1}, {0, 1}},
        {{0, 0}, {6, 0}, {6, 2}, {5, 2}, {5, 1}, {4, 1}, {4, 4}, {5, 4}, {5, 3}, {6, 3}, {6, 5}, {0, 5}}};
    for (size_t k = 0; k < outlines.size(); ++k)
        for (int quarter = 0; quarter < 4; ++quarter) {
            Draws draw(k);
            expectSigns(turned(footprintOf(polygonOf(outlines[k])), quarter * pi / 2), draw, 400,
                        "outline " + std::to_string(k));
        }
}

TEST(Formula, SeveralPolygonsAreJoined) {
    Footprint f = *ring(20, 15, 4);
    f.polygons.push_back(placed(*ell(8, 8, 3, 2), {1, 1}, {30, 0}).polygons[0]);
    f.polygons.push_back(placed(*rectangle(3, 3), {1, 1}, {0, 0}).polygons[0]);  // in the court
    ASSERT_FALSE(firstFault(f));
    Draws draw(7);
    expectSigns(f, draw, 2000, "three");
}

TEST(Formula, CrossingOutlinesAreErrorsThatNameTheEdges) {
    const auto bad = monotoneFormula(footprintOf({ringOf({{0, 0}, {2, 2}, {2, 0}, {0, 2}}), {}}));
    ASSERT_FALSE(bad.ok());
    EXPECT_NE(bad.error().message.find("edge 1 of the outline meets edge 3"), std::string::npos);
}

TEST(Formula, TenThousandEdgesTakeAMoment) {
    Draws draw(1);
    const double before = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    for (const Footprint& f : {footprintOf(polygonOf(test::comb(draw, 2500))), *ngon(10'000, 100)})
        ASSERT_TRUE(monotoneFormula(f).ok());
    EXPECT_LT(secondsOf(CLOCK_PROCESS_CPUTIME_ID) - before, boundSeconds(4));
}

TEST(Formula, TheDepthOfARectangleIsHalfItsWidth) {
    const Footprint f = *rectangle(10, 4);
    const Formula formula = *monotoneFormula(f);
    const auto d = distancesOf(f);
    const double least = leastInside(formula, d, d, bounds(f), 1e-3);
    EXPECT_LE(least, -2);
    EXPECT_GE(least, -2 - 2e-3);
}

/// The least value inside, box by box: leastInside takes two boxes at a time and must make the same choices.
double leastOneByOne(const Formula& formula, std::span<const Linear> leaves, std::span<const Linear> outline,
                     const Box2& whole, double tolerance) {
    const auto lowest = [&](std::span<const Linear> of, const Box2& box) {
        std::vector<double> values;
        for (const FormulaNode& node : formula.nodes) {
            if (node.kind == FormulaNode::Kind::Edge) {
                const Linear& l = of[node.first];
                values.push_back(l.at({l.a < 0 ? box.hi.x : box.lo.x, l.b < 0 ? box.hi.z : box.lo.z}));
            } else {
                const double a = values[node.first], b = values[node.second];
                values.push_back(node.kind == FormulaNode::Kind::Max ? std::max(a, b) : std::min(a, b));
            }
        }
        return values.back();
    };
    using Candidate = std::pair<double, Box2>;
    const auto later = [](const Candidate& a, const Candidate& b) { return a.first > b.first; };
    std::priority_queue<Candidate, std::vector<Candidate>, decltype(later)> queue(later);
    double reached = Box2::far;
    const auto add = [&](const Box2& box) {
        if (lowest(outline, box) > 0) return;
        const double bound = lowest(leaves, box);
        if (valueOf(formula, outline, box.centre()) <= 0)
            reached = std::min(reached, valueOf(formula, leaves, box.centre()));
        if (bound < reached - tolerance) queue.push({bound, box});
    };
    add(whole);
    for (size_t n = 0; n < 4096 && !queue.empty() && queue.top().first < reached - tolerance; ++n) {
        const Box2 b = queue.top().second;
        queue.pop();
        Box2 low = b, high = b;
        if (b.size().x > b.size().z)
            low.hi.x = high.lo.x = b.centre().x;
        else
            low.hi.z = high.lo.z = b.centre().z;
        add(low);
        add(high);
    }
    return std::min(queue.empty() ? Box2::far : queue.top().first, reached - tolerance);
}

TEST(Formula, TheLeastInsideIsThatOfASearchBoxByBox) {
    Draws draw(7);
    for (int round = 0; round < 44; ++round) {
        Footprint f = round % 2 ? *ngon(3 + round, 5 + round) : footprintOf(polygonOf(test::comb(draw, 2 + round / 4)));
        if (round >= 40) {  // courts, and polygons side by side
            f = *plan::ring(30, 24, 4 + round % 4);
            f.polygons.push_back(placed(*ell(16, 12, 5, 6), {1, 1}, {30, round - 42.}).polygons[0]);
        }
        const Formula formula = *monotoneFormula(f);
        const auto outline = distancesOf(f);
        std::vector<Linear> leaves = outline;
        for (size_t i = 0; i < leaves.size(); i += 3)
            leaves[i] = {leaves[i].a * .5, leaves[i].b * .5, leaves[i].c * .5 - .25};
        const double tolerance = round % 4 < 2 ? 1e-3 : .1;
        EXPECT_EQ(leastInside(formula, leaves, outline, bounds(f), tolerance),
                  leastOneByOne(formula, leaves, outline, bounds(f), tolerance));
        EXPECT_EQ(leastInside(formula, outline, outline, bounds(f), tolerance),
                  leastOneByOne(formula, outline, outline, bounds(f), tolerance));
    }
}

TEST(Formula, TheDeepestPointIsExact) {
    const auto depthOf = [](const Footprint& plan) { return deepestPoint(plan, *monotoneFormula(plan)).depth; };
    EXPECT_NEAR(depthOf(*ring(30, 24, 7)), 3.5, 1e-9);
    EXPECT_NEAR(depthOf(*rectangle(12, 8)), 4, 1e-9);
    EXPECT_NEAR(depthOf(*ngon(7, 5)), 5 * std::cos(pi / 7), 1e-9);
    EXPECT_NEAR(depthOf(*ell(16, 12, 5, 6)), 3, 1e-9) << "on the ridge of the wider arm";
    const Footprint odd = *ell(16, 12, 5, 6);
    const Deepest deepest = deepestPoint(odd, *monotoneFormula(odd));
    for (const Vec2 step : {Vec2{1e-3, 0}, {-1e-3, 0}, {0, 1e-3}, {0, -1e-3}})
        EXPECT_GE(valueOf(*monotoneFormula(odd), distancesOf(odd), deepest.at + step), -deepest.depth - 1e-12);
}

TEST(Formula, SlopesReachTheirRidges) {
    const Footprint f = *rectangle(10, 4);
    const Formula formula = *monotoneFormula(f);
    const auto d = distancesOf(f);
    EXPECT_NEAR(slopeDepth(f, formula, d, 0, .5), 2, 1e-9);
    EXPECT_NEAR(slopeDepth(f, formula, d, 0, .1), 1, 1e-9) << "to the hip";
    EXPECT_NEAR(slopeDepth(f, formula, d, 1, .5), 2, 1e-9);
    EXPECT_NEAR(slopeDepth(f, formula, d, 1, .25), 1, 1e-9);
    const Deepest middle = deepestPoint(*ngon(8, 5), *monotoneFormula(*ngon(8, 5)));
    EXPECT_NEAR(length(middle.at), 0, .1);
    EXPECT_NEAR(middle.depth, 5 * std::cos(pi / 8), .02);
    const Footprint l = *ell(16, 14, 6, 4);
    const Formula ofL = *monotoneFormula(l);
    const auto dl = distancesOf(l);
    double deepest = 0;
    for (uint32_t e = 0; e < 6; ++e)
        for (const double share : {.1, .3, .5, .7, .9}) {
            const double depth = slopeDepth(l, ofL, dl, e, share);
            const PlacedEdge at = edgesOf(l)[e];
            const Vec2 ridge = at.from + (at.to - at.from) * share - at.normal() * depth;
            EXPECT_NEAR(valueOf(ofL, dl, ridge), -depth, 1e-9);
            deepest = std::max(deepest, depth);
        }
    EXPECT_NEAR(deepest, 3, .01);
}

TEST(Formula, GableEndsAreTheShortSidesOfWings) {
    const auto endsOf = [](const Footprint& f) { return gableEnds(f, *monotoneFormula(f)); };
    EXPECT_EQ(endsOf(*rectangle(10, 4)), (std::vector<uint32_t>{1, 3}));
    EXPECT_EQ(endsOf(*rectangle(4, 10)), (std::vector<uint32_t>{0, 2}));
    EXPECT_EQ(endsOf(*rectangle(5, 5)).size(), 2u);
    EXPECT_EQ(endsOf(*ell(16, 16, 6, 6)).size(), 2u);
    EXPECT_EQ(endsOf(*tee(20, 16, 6, 5)).size(), 3u);
    EXPECT_TRUE(endsOf(*ngon(64, 5)).empty());
    EXPECT_TRUE(endsOf(*ngon(3, 5)).size() <= 1);
}

}  // namespace
}  // namespace sgm::plan
