// Measures, shapes and the faults that validation names.
#include <gmock/gmock.h>

#include "modeler/plan/shapes.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

using testing::HasSubstr;

Footprint square(double half) { return *rectangle(2 * half, 2 * half); }

FaultKind kindOf(const Footprint& f) {
    const auto fault = firstFault(f);
    EXPECT_TRUE(fault.has_value());
    return fault ? fault->kind : FaultKind::Empty;
}

TEST(Polygon, MeasuresOfShapesAreClosedForms) {
    EXPECT_DOUBLE_EQ(area(*rectangle(4, 3)), 12);
    EXPECT_DOUBLE_EQ(perimeter(*rectangle(4, 3)), 14);
    EXPECT_DOUBLE_EQ(area(*ell(16, 16, 8, 6)), 16 * 8 + 6 * 8);
    EXPECT_DOUBLE_EQ(area(*tee(10, 12, 4, 3)), 10 * 4 + 3 * 8);
    EXPECT_DOUBLE_EQ(area(*yard(20, 15, 4)), 20 * 15 - 12 * 11);
    EXPECT_DOUBLE_EQ(area(*ring(20, 15, 4)), 20 * 15 - 12 * 7);
    EXPECT_NEAR(area(*ngon(6, 2)), 6 * std::sqrt(3), 1e-12);
    EXPECT_NEAR(area(*round(24, 5)), pi * 25, 1e-10);
    const double sweep = radians(115), chord = sweep / 24;
    EXPECT_NEAR(area(*arc(33, 44, radians(15), radians(130), 24)), 12 * std::sin(chord) * (44 * 44 - 33 * 33), 1e-9);
}

TEST(Polygon, ShapesAreSoundAndCentred) {
    for (const auto& f :
         {rectangle(4, 3), ell(16, 14, 8, 5), tee(10, 12, 4, 3), yard(20, 15, 4), ring(20, 15, 4), ngon(4, 2)}) {
        ASSERT_TRUE(f.ok());
        EXPECT_FALSE(firstFault(*f)) << sentenceOf(*firstFault(*f), *f);
        EXPECT_NEAR(length(bounds(*f).centre()), 0, 1e-12);
    }
    for (const int n : {3, 4, 5, 64, 1000}) EXPECT_FALSE(firstFault(*ngon(n, 20))) << n;
    EXPECT_FALSE(firstFault(*arc(3, 4, 0, radians(359), 90)));
}

TEST(Polygon, ShapesNameTheLengthThatDoesNotFit) {
    EXPECT_THAT(ell(16, 16, 17, 8).error().message, HasSubstr("'wing along x' of ell is 17 m"));
    EXPECT_THAT(yard(10, 8, 5).error().message, HasSubstr("'wing' of yard"));
    EXPECT_THAT(ngon(2, 1).error().message, HasSubstr("3 to 10,000"));
    EXPECT_THAT(arc(5, 4, 0, 1, 3).error().message, HasSubstr("inner radius"));
    EXPECT_THAT(arc(3, 4, 0, 7, 8).error().message, HasSubstr("degrees"));
    EXPECT_FALSE(rectangle(std::nan(""), 3).ok());
    EXPECT_FALSE(rectangle(1, -3).ok());
}

TEST(Polygon, TagsAndFacingsSurviveReversing) {
    const Footprint f = *arc(3, 4, 0, 1, 2);
    const Ring back = reversed(f.polygons[0].outer);
    for (size_t i = 0; i < back.size(); ++i) {
        const Ring& r = f.polygons[0].outer;
        bool found = false;
        for (size_t j = 0; j < r.size(); ++j)
            found = found || (r.from(j) == back.to(i) && r.to(j) == back.from(i) && r.edges[j] == back.edges[i]);
        EXPECT_TRUE(found) << i;
    }
    EXPECT_EQ(facingOf({0, 1}), Facing::Front);
    EXPECT_EQ(facingOf({-1, .2}), Facing::Left);
    const auto edges = edgesOf(square(1));
    EXPECT_EQ(facingOf(edges[0].normal()), Facing::Back);
    EXPECT_EQ(facingOf(edges[1].normal()), Facing::Right);
}

TEST(Polygon, MirroringKeepsTheSolidOnTheLeft) {
    const Footprint f = placed(*ring(20, 15, 4), {-2, 1}, {3, 4});
    EXPECT_FALSE(firstFault(f));
    EXPECT_DOUBLE_EQ(area(f), 2 * area(*ring(20, 15, 4)));
    EXPECT_NEAR(length(centroid(f) - Vec2{3, 4}), 0, 1e-12);
}

TEST(Validate, NamesTheFirstFaultAndItsEdge) {
    const auto of = [](std::vector<Vec2> points) { return footprintOf({ringOf(std::move(points)), {}}); };
    EXPECT_EQ(kindOf(Footprint{}), FaultKind::Empty);
    EXPECT_EQ(kindOf(of({{0, 0}, {1, 0}})), FaultKind::TooFewPoints);
    EXPECT_EQ(kindOf(of({{0, 0}, {1, 0}, {1, std::nan("")}})), FaultKind::NotFinite);
    EXPECT_EQ(kindOf(of({{0, 0}, {1, 0}, {1, 2e7}})), FaultKind::TooFar);
    EXPECT_EQ(kindOf(of({{0, 0}, {1, 0}, {1, 0}, {0, 1}})), FaultKind::SamePoint);
    EXPECT_EQ(kindOf(of({{0, 0}, {1, 0}, {1, 5e-4}, {0, 1}})), FaultKind::ShortEdge);
    EXPECT_EQ(kindOf(of({{0, 0}, {0, 1}, {1, 0}})), FaultKind::WrongWay);
    EXPECT_EQ(kindOf(of({{0, 0}, {2, 0}, {1, 0}})), FaultKind::Crossing);
    const Footprint bow = of({{0, 0}, {2, 2}, {2, 0}, {0, 2}});
    const Fault fault = *firstFault(bow);
    EXPECT_EQ(fault.kind, FaultKind::Crossing);
    EXPECT_EQ(fault.edge, 0u);
    EXPECT_EQ(fault.otherEdge, 2u);
    EXPECT_NEAR(length(fault.at - Vec2{1, 1}), 0, 1e-9);
    EXPECT_THAT(sentenceOf(fault, bow), HasSubstr("edge 1 of the outline meets edge 3 of the outline near (1, 1)"));
    EXPECT_EQ(kindOf(of({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})), FaultKind::Crossing) << "a corner on an edge";
    const Footprint star = of({{0, 2}, {-1.2, -1.6}, {1.9, .6}, {-1.9, .6}, {1.2, -1.6}});
    EXPECT_EQ(kindOf(star), FaultKind::Crossing) << "it turns left at every corner, twice around";
    const Footprint around = of({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {-1, 1}, {3, 1}, {3, 3}, {1, 3}});
    EXPECT_EQ(kindOf(around), FaultKind::Crossing);
    EXPECT_FALSE(firstFault(of({{0, 0}, {2, -1}, {4, 0}, {5, 2}, {4, 4}, {2, 5}, {0, 4}, {-1, 2}})));
    EXPECT_FALSE(firstFault(of({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}}))) << "a corner of 180 degrees";
    Footprint spiked = square(1);
    spiked.polygons[0].outer.edges.pop_back();
    EXPECT_EQ(kindOf(spiked), FaultKind::EdgeList);
}

TEST(Validate, CourtsLieInsideAndApart) {
    Footprint f = square(5);
    const Ring court = ringOf({{-1, -1}, {-1, 1}, {1, 1}, {1, -1}});
    const auto with = [&](Vec2 by) {
        Footprint g = f;
        Ring moved = court;
        for (Vec2& p : moved.points) p = p + by;
        g.polygons[0].courts.push_back(moved);
        return g;
    };
    EXPECT_FALSE(firstFault(with({0, 0})));
    EXPECT_EQ(kindOf(with({4.5, 0})), FaultKind::Crossing);
    EXPECT_EQ(kindOf(with({4, 0})), FaultKind::Crossing) << "touching";
    EXPECT_EQ(kindOf(with({9, 0})), FaultKind::CourtOutside);
    f = with({0, 0});
    f.polygons[0].courts[0] = reversed(f.polygons[0].courts[0]);
    EXPECT_EQ(kindOf(f), FaultKind::WrongWay);
    f = square(5);
    f.polygons.push_back(square(1).polygons[0]);
    EXPECT_EQ(kindOf(f), FaultKind::Overlap);
}

TEST(Validate, TooManyPointsAreRefusedAtOnce) {
    EXPECT_EQ(kindOf(footprintOf({ringOf(std::vector<Vec2>(200'000)), {}})), FaultKind::TooManyPoints);
}

TEST(Validate, CleaningDropsWhatSaysNothing) {
    Footprint f = footprintOf({ringOf({{0, 0}, {1, 0}, {2, 1e-5}, {4, 0}, {4, 3}, {4, 3.0002}, {0, 3}}), {}});
    EXPECT_EQ(cleaned(f).polygons[0].outer.size(), 4u);
    f.polygons[0].outer.edges[1].tag = f.tag("street");
    const Ring kept = cleaned(f).polygons[0].outer;
    EXPECT_EQ(kept.size(), 6u) << "corners between tags stay";
    f.polygons[0].outer = reversed(f.polygons[0].outer);
    EXPECT_FALSE(firstFault(cleaned(f)));
    EXPECT_TRUE(cleaned(footprintOf({ringOf({{0, 0}, {1, 0}, {2, 0}}), {}})).empty());
    const auto bent = [](double by) { return footprintOf({ringOf({{0, 0}, {3, -by}, {4, 0}, {4, 3}, {0, 3}}), {}}); };
    EXPECT_EQ(cleaned(bent(.99e-3)).polygons[0].outer.size(), 4u) << "within a millimetre of the line";
    EXPECT_EQ(cleaned(bent(1.01e-3)).polygons[0].outer.size(), 5u);
}

}  // namespace
}  // namespace sgm::plan
