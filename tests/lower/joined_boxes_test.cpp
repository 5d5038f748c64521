// Boxes that stand side by side as larger ones.
#include "grammar/lower/joined_boxes.h"

#include <gtest/gtest.h>

#include "modeler/core/random.h"
#include "tests/lower/lowered.h"

namespace sgm::lower {
namespace {

derive::Scope box(Vec3d lo, Vec3d hi, const Mat3& axes = Mat3::rotation({0, 1, 0}, 0.3)) {
    return {axes * ((lo + hi) * 0.5), axes, hi - lo};
}

double volumeOf(const std::vector<JoinedBox>& boxes) {
    double volume = 0;
    for (const JoinedBox& b : boxes) volume += b.scope.size.x * b.scope.size.y * b.scope.size.z;
    return volume;
}

TEST(JoinedBoxes, AWallOfTilesIsOneBox) {
    std::vector<derive::Scope> tiles;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) tiles.push_back(box({i / 3.0, j * .7, 0}, {(i + 1) / 3.0, (j + 1) * .7, .3}));
    const auto joined = joinBoxes(tiles, std::vector<uint32_t>(tiles.size(), 5));
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0].first, 0u);
    EXPECT_NEAR(joined[0].scope.size.x, 1, 1e-9);
    EXPECT_NEAR(joined[0].scope.size.y, 2.8, 1e-9);
    EXPECT_NEAR(joined[0].scope.size.z, .3, 1e-9);
    const Vec3d middle = joined[0].scope.axes * Vec3d{.5, 1.4, .15};
    EXPECT_NEAR(length(joined[0].scope.centre - middle), 0, 1e-9);
}

TEST(JoinedBoxes, WindowsAndOtherMaterialsStay) {
    // A window amid a wall: two piers as high as it, a sill and a lintel, in another order.
    const std::vector<derive::Scope> parts{
        box({1, 1, 0}, {2, 2, .1}), box({0, 0, 0}, {1, 1, .3}), box({0, 1, 0}, {1, 2, .3}),
        box({0, 2, 0}, {1, 3, .3}), box({1, 0, 0}, {2, 1, .3}), box({1, 2, 0}, {2, 3, .3}),
        box({2, 0, 0}, {3, 1, .3}), box({2, 1, 0}, {3, 2, .3}), box({2, 2, 0}, {3, 3, .3})};
    const auto joined = joinBoxes(parts, std::vector<uint32_t>{7, 1, 1, 1, 1, 1, 1, 1, 1});
    EXPECT_EQ(joined.size(), 5u);  // the window, two rows of three, two piers
    EXPECT_NEAR(volumeOf(joined), .1 + 8 * .3, 1e-9);
    EXPECT_EQ(joined[0].first, 0u);
    EXPECT_EQ(joined[0].scope, parts[0]);
}

TEST(JoinedBoxes, OnesThatOnlyTouchOrOverlapStay) {
    const std::vector<derive::Scope> parts{box({0, 0, 0}, {1, 1, 1}),   box({1, 0, 0}, {2, 1.001, 1}),
                                           box({1.9, 3, 0}, {3, 4, 1}), box({2.8, 3, 0}, {4, 4, 1}),
                                           box({6, 0, 0}, {7, 1, 1}),   box({7.0001, 0, 0}, {8, 1, 1})};
    const auto joined = joinBoxes(parts, std::vector<uint32_t>(parts.size(), 1));
    ASSERT_EQ(joined.size(), parts.size());
    for (size_t i = 0; i < parts.size(); ++i) EXPECT_EQ(joined[i].scope, parts[i]) << i;
}

/// A house with windows, an opening cut out of a tower, a blended step.
constexpr const char* house = R"(grammar 2
terminal pane color #88aacc
start House -> size (8m, 6m, 5m) faces .3m { side: Wall | rest: block } + Tower
rule Wall -> split y { { ~3m: Floor }* }
rule Floor -> split x { ~.5: block | { ~2m: Bay }* | ~.5: block }
rule Bay -> split x { ~1: block | 1m: Window | ~1: block }
rule Window -> split y { ~1: block | 1.4m: pane size (100%, 100%, 30%) | ~.7: block }
rule Tower -> size (2m, 4m, 2m) move (0m, 5m, 0m) (split y { { 1m: cube }* } - cube size (1m, 2m, 3m)
              + cube size (3m, .4m, 3m) blend .2m)
)";

TEST(JoinedBoxes, FillTheSameSpaceInAModel) {
    const testing_::Lowered apart(house), joined(house, {}, true);
    ASSERT_TRUE(apart.model && joined.model);
    EXPECT_LT(joined.tape().size(), apart.tape().size() * 3 / 4);
    const Box3f bounds = apart.model->field.bounds;
    uint64_t draw = 7;
    for (int i = 0; i < 20000; ++i) {
        Vec3f p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = bounds.lo[axis] + bounds.size()[axis] * static_cast<float>(uniform(draw = mix(draw)));
        const float f = apart.value(p);
        if (std::abs(f) < 1e-4f) continue;
        ASSERT_EQ(joined.inside(p), f < 0) << p.x << ' ' << p.y << ' ' << p.z;
        if (f < 0) {
            EXPECT_EQ(joined.owner(p).material, apart.owner(p).material);
        }
    }
}

TEST(JoinedBoxes, NoneAreNone) { EXPECT_TRUE(joinBoxes({}, {}).empty()); }

}  // namespace
}  // namespace sgm::lower
