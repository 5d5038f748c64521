#include <cmath>

#include "modeler/eval/values_interval.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

TEST(Math, SineAndCosineAreWithinTheirErrorUpToTenThousandRadians) {
    for (int i = -200000; i <= 200000; ++i) {
        const float a = static_cast<float>(i) * 0.05f;
        ASSERT_NEAR(ops::Sin::apply(a), std::sin(double{a}), double{ops::mathError}) << a;
        ASSERT_NEAR(ops::Cos::apply(a), std::cos(double{a}), double{ops::mathError}) << a;
    }
}

TEST(Math, OfAnglesWithoutEndNothingIsKnown) {
    using I = Interval<float>;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const I angle :
         {I{0, infinity}, I{-infinity, 0}, I{-infinity, infinity}, I{infinity, infinity}, I{5e8f, 5e8f}}) {
        EXPECT_FALSE(known(ops::Sin::interval(angle)));
        EXPECT_FALSE(known(ops::Cos::interval(angle)));
    }
    // Beyond ten thousand radians it is that there is a sine.
    Draws draws{5};
    for (int i = 0; i < 100000; ++i) {
        const float a = draws.real(-1e6, 1e6);
        const I all = ops::Sin::interval(I{a, a});
        ASSERT_LE(all.lo, ops::Sin::apply(a)) << a;
        ASSERT_GE(all.hi, ops::Sin::apply(a)) << a;
    }
}

TEST(Math, ExponentialIsWithinItsRelativeError) {
    for (int i = -86999; i < 88000; ++i) {
        const float a = static_cast<float>(i) * 0.001f;
        ASSERT_NEAR(ops::Exp::apply(a) / std::exp(double{a}), 1.0, double{ops::mathError}) << a;
    }
}

TEST(Math, AngleIsWithinItsErrorAllAround) {
    Draws draws{5};
    for (int i = 0; i < 200000; ++i) {
        const float size = std::pow(10.0f, draws.real(-6, 6)), x = size * draws.real(-1, 1),
                    y = size * draws.real(-1, 1);
        ASSERT_NEAR(ops::Atan2::apply(y, x), std::atan2(double{y}, double{x}), double{ops::mathError})
            << y << ", " << x;
    }
    EXPECT_EQ(ops::Atan2::apply(0.0f, 0.0f), 0.0f);
    EXPECT_FLOAT_EQ(ops::Atan2::apply(0.0f, -1.0f), 3.14159265f);
}

}  // namespace
}  // namespace sgm::eval::testing
