// Clips, splits by area and splits along chains: parts sum to the whole and are sound.
#include "modeler/plan/cut.h"

#include <gtest/gtest.h>

#include "modeler/core/conventions.h"
#include "modeler/plan/shapes.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

Chain chainOf(const Footprint& f, std::string_view tag) {
    std::vector<bool> belongs;
    for (const PlacedEdge& e : edgesOf(f)) belongs.push_back(f.tags[e.edge.tag] == tag);
    return longestChain(f, belongs);
}

void expectSound(const Footprint& f, const std::string& what = "") {
    if (f.empty()) return;
    const auto fault = firstFault(f);
    EXPECT_FALSE(fault) << what << sentenceOf(*fault, f);
}

TEST(Cut, HalfPlanesClip) {
    const Footprint f = *ell(16, 14, 6, 5);
    const Footprint low = clipped(f, {{0, 1}, -2}), high = clipped(f, {{0, -1}, 2});
    EXPECT_NEAR(area(low), 16 * 5, 1e-4);
    EXPECT_NEAR(area(low) + area(high), area(f), 1e-4);
    int cuts = 0;
    for (const PlacedEdge& e : edgesOf(low)) cuts += e.edge.source == EdgeSource::Cut;
    EXPECT_EQ(cuts, 1);
    EXPECT_TRUE(clipped(f, {{1, 0}, -100}).empty());
    EXPECT_EQ(clipped(f, {{1, 0}, 100}), f);
    EXPECT_NEAR(area(between(f, 0, -8, -3)), 5 * 14, 1e-4);
}

TEST(Cut, ClippedPartsSumToTheWhole) {
    for (uint64_t key = 0; key < 200; ++key) {
        const Footprint f = test::anyPlan(key);
        test::Draws draw(key);
        const double angle = draw.real(0, 6.28);
        const HalfPlane one{{std::cos(angle), std::sin(angle)}, draw.real(-4, 4)}, other{one.normal * -1, -one.offset};
        const Footprint a = clipped(f, one), b = clipped(f, other);
        expectSound(a, std::to_string(key));
        expectSound(b, std::to_string(key));
        EXPECT_NEAR(area(a) + area(b), area(f), .02) << key;
    }
}

TEST(Cut, AreasAreMet) {
    const Footprint f = *ell(20, 16, 6, 5);
    const std::vector<double> wanted{30, 50, 0, 20};
    const auto parts = splitByArea(f, 0, wanted);
    ASSERT_EQ(parts.size(), 5u);
    double sum = 0;
    for (size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_NEAR(area(parts[i]), wanted[i], 1e-4);
        sum += wanted[i];
    }
    EXPECT_NEAR(area(parts.back()), area(f) - sum, 1e-3);
    EXPECT_TRUE(splitByArea(f, 1, std::vector<double>{1e6, 5})[1].empty());
}

TEST(Cut, ChainsAreFoundByTags) {
    const Footprint f = *arc(33, 44, radians(15), radians(130), 24);
    const Chain outer = chainOf(f, "outer"), inner = chainOf(f, "inner"), end = chainOf(f, "end");
    EXPECT_EQ(outer.count, 24u);
    EXPECT_EQ(inner.count, 24u);
    EXPECT_EQ(end.count, 1u);
    EXPECT_NEAR(length(f, outer), 24 * 2 * 44 * std::sin(radians(115) / 48), 1e-9);
    EXPECT_EQ(chainOf(f, "nothing").count, 0u);
    EXPECT_EQ(longestChain(f, std::vector<bool>(f.edgeCount(), true)).count, 50u);
}

TEST(Cut, ACrescentOfHousesIsCutSquareToItsStreet) {
    for (const char* street : {"outer", "inner"}) {
        const Footprint f = *arc(33, 44, radians(15), radians(130), 24);
        const Chain chain = chainOf(f, street);
        const double whole = length(f, chain);
        std::vector<double> at;
        for (int i = 1; i < 13; ++i) at.push_back(whole * i / 13);
        const auto parts = splitAlong(f, chain, at);
        ASSERT_TRUE(parts.ok());
        ASSERT_EQ(parts->size(), 13u);
        double sum = 0;
        for (const AlongPart& part : *parts) {
            EXPECT_NEAR(area(part.footprint), area(f) / 13, .6) << street;
            expectSound(part.footprint);
            sum += area(part.footprint);
            EXPECT_NEAR(length(part.to - part.from), whole / 13, .05);
            EXPECT_GT(distanceToEdges(part.footprint, (part.from + part.to) * .5) + 1, 1);
        }
        EXPECT_NEAR(sum, area(f), 1e-3);
        for (size_t i = 0; i + 1 < parts->size(); ++i) EXPECT_EQ((*parts)[i].to, (*parts)[i + 1].from);
    }
}

TEST(Cut, LotsOfABlockWithACourt) {
    Footprint f = *ring(60, 40, 12);
    Chain all{0, 0, 0, 4};
    const double whole = length(f, all);
    EXPECT_NEAR(whole, 200, 1e-9);
    const std::vector<double> at{14, 30, 46, 60, 74, 86, 100, 114, 130, 146, 160, 174, 186};
    const auto parts = splitAlong(f, all, at);
    ASSERT_TRUE(parts.ok());
    double sum = 0;
    for (const AlongPart& part : *parts) {
        EXPECT_GT(area(part.footprint), 20);
        expectSound(part.footprint);
        sum += area(part.footprint);
    }
    EXPECT_NEAR(sum, area(f), 1e-2);
}

TEST(Cut, RandomPlansSplitAlongTheirLongestSides) {
    for (uint64_t key = 0; key < 400; ++key) {
        const Footprint f = test::anyPlan(key);
        test::Draws draw(key);
        std::vector<bool> belongs;
        for (size_t i = 0; i < f.edgeCount(); ++i) belongs.push_back(draw.chance(.7));
        const Chain chain = longestChain(f, belongs);
        if (chain.count == 0) continue;
        const double whole = length(f, chain);
        std::vector<double> at;
        for (double x = draw.real(.3, 3); x < whole - .1; x += draw.real(.3, 4)) at.push_back(x);
        const auto parts = splitAlong(f, chain, at);
        ASSERT_TRUE(parts.ok()) << key << parts.error().message;
        ASSERT_EQ(parts->size(), at.size() + 1);
        double sum = 0;
        for (const AlongPart& part : *parts) {
            expectSound(part.footprint, std::to_string(key));
            sum += area(part.footprint);
        }
        EXPECT_NEAR(sum, area(f), .01 * area(f) + .01) << key;
    }
}

TEST(Cut, LengthsOutsideTheChainAreRefused) {
    const Footprint f = *rectangle(10, 5);
    const Chain side{0, 0, 0, 1};
    EXPECT_FALSE(splitAlong(f, side, std::vector<double>{10}).ok());
    EXPECT_FALSE(splitAlong(f, side, std::vector<double>{4, 4}).ok());
    EXPECT_FALSE(splitAlong(f, {0, 0, 0, 0}, {}).ok());
    EXPECT_FALSE(splitAlong(f, {2, 0, 0, 1}, {}).ok());
    EXPECT_EQ(splitAlong(f, side, {})->size(), 1u);
    const auto halves = splitAlong(f, side, std::vector<double>{4});
    EXPECT_NEAR(area((*halves)[0].footprint), 20, 1e-4);
}

}  // namespace
}  // namespace sgm::plan
