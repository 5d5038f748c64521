// The depth of rectilinear plans against CGAL's straight skeleton.
#include "tests/plan/skeleton.h"

#include <gtest/gtest.h>

#include "modeler/plan/formula.h"
#include "modeler/plan/shapes.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

/// How far the formula's depth is from the skeleton's, at the nodes and at points between them, metres.
double mostOff(const Footprint& f) {
    const Formula formula = *monotoneFormula(f);
    const auto distances = distancesOf(f);
    double most = 0;
    const auto faces = test::skeletonOf(f.polygons[0]);
    EXPECT_FALSE(faces.empty());
    for (const test::SkeletonFace& face : faces)
        for (size_t i = 0; i < face.corners.size(); ++i)
            for (size_t j = i; j < face.corners.size(); ++j) {
                // Between two corners of a face the skeleton's depth is no more than linear; on its sides it is linear.
                const bool side = j == i || j == i + 1 || (i == 0 && j + 1 == face.corners.size());
                if (!side) continue;
                for (const double t : {0.0, .3, .5, .9}) {
                    const Vec2 p = face.corners[i] * (1 - t) + face.corners[j] * t;
                    const double depth = face.depths[i] * (1 - t) + face.depths[j] * t;
                    most = std::max(most, std::abs(-valueOf(formula, distances, p) - depth));
                }
            }
    return most;
}

TEST(Skeleton, NamedPlansHaveItsDepth) {
    for (const auto& f : {*ell(16, 14, 6, 5), *tee(18, 15, 6, 5), *yard(20, 15, 4), *ring(20, 16, 4), *rectangle(9, 4),
                          *arc(11, 16, .2, 2.1, 12), *round(24, 6)}) {
        EXPECT_LT(mostOff(f), 1e-9);
        EXPECT_LT(mostOff(turned(f, .3)), 1e-6);
    }
}

TEST(Skeleton, RandomRectilinearPlansHaveItsDepth) {
    int withCourts = 0;
    for (uint64_t key = 0; key < 1000; ++key) {
        test::Draws draw(combine(hashText("rectilinear"), key));
        const Footprint f = test::rectilinear(draw, 9, draw.whole(3, 34));
        ASSERT_FALSE(firstFault(f));
        withCourts += !f.polygons[0].courts.empty();
        ASSERT_LT(mostOff(f), 1e-6) << "plan " << key << " of " << f.edgeCount() << " edges";
    }
    EXPECT_GT(withCourts, 50);
}

/// Where the depth isn't the skeleton's it is still near it: corners off by up to 5 cm, as surveyors measure.
TEST(Skeleton, SurveyedPlansAreMostlyExactAndElsewhereNear) {
    int plans = 0, exact = 0;
    double most = 0;
    for (uint64_t key = 0; key < 300; ++key) {
        test::Draws draw(combine(hashText("surveyed"), key));
        Footprint f = test::rectilinear(draw, 8, draw.whole(3, 20), false);
        for (Vec2& p : f.polygons[0].outer.points) p = p + Vec2{draw.real(-.05, .05), draw.real(-.05, .05)};
        if (firstFault(f)) continue;
        const double off = mostOff(f);
        ++plans, exact += off < 1e-6;
        most = std::max(most, off);
    }
    RecordProperty("exact", exact);
    RecordProperty("plans", plans);
    RecordProperty("most_mm", static_cast<int>(most * 1000));
    EXPECT_GT(plans, 250);
    EXPECT_GT(exact, .9 * plans) << exact << " of " << plans;
    EXPECT_LT(most, .3) << exact << " of " << plans;
}

}  // namespace
}  // namespace sgm::plan
