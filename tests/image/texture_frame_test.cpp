// Where textures begin on a shape that is laid.
#include "modeler/image/texture_frame.h"

#include <gtest/gtest.h>

namespace sgm::image {
namespace {

/// A box of 6 m x 3 m x 4 m about the origin, turned: front, right, back and left side.
TextureFrame boxFrame(const Mat3& axes) {
    TextureFrame frame{axes * Vec3d{-3, -1.5, 2}, axes, {6, 3, 4}, {}};
    const Vec3d corners[] = {{0, 0, 0}, {6, 0, 0}, {6, 0, -4}, {0, 0, -4}};
    double at_m = 0;
    for (size_t i = 0; i < 4; ++i) {
        const Vec3d along = corners[(i + 1) % 4] - corners[i];
        frame.sides.push_back({corners[i], normalized(along), length(along), at_m, 20});
        at_m += length(along);
    }
    return frame;
}

double uAt(const TextureMap& map, Vec3d p) { return (dot(p, map.u) - map.begin_m[0]) * map.stretch[0]; }
double vAt(const TextureMap& map, Vec3d p) { return (dot(p, map.v) - map.begin_m[1]) * map.stretch[1]; }

TEST(TextureFrame, RunsOnAroundTheCorners) {
    for (const Mat3& axes : {Mat3{}, Mat3::rotation({.3, 1, -.2}, .7)}) {
        const TextureFrame frame = boxFrame(axes);
        const Vec3d normals[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
        const Vec3d corners[] = {{-3, 1, 2}, {3, 1, 2}, {3, 1, -2}, {-3, 1, -2}, {-3, 1, 2}};
        const double expected[] = {0, 6, 10, 16, 20};
        for (size_t i = 0; i < 4; ++i) {
            const Vec3d middle = axes * ((corners[i] + corners[i + 1]) * .5);
            const TextureMap map = mapFace(&frame, axes, nullptr, true, axes * normals[i], middle);
            EXPECT_NEAR(uAt(map, axes * corners[i]), expected[i], 1e-12) << i;
            EXPECT_NEAR(uAt(map, axes * corners[i + 1]), expected[i + 1], 1e-12) << i;
            EXPECT_NEAR(vAt(map, middle), 2.5, 1e-12) << "above the foot";
        }
    }
}

TEST(TextureFrame, TakesTheNearestOfSidesThatLookAlike) {
    TextureFrame frame = boxFrame({});
    frame.sides.push_back({{8, 0, -3}, {1, 0, 0}, 2, 100, 20});  // another front, farther back
    const TextureMap map = mapFace(&frame, {}, nullptr, true, {0, 0, 1}, {5.5, 0, -1});
    EXPECT_NEAR(uAt(map, {5, 0, -1}), 100, 1e-12);
}

TEST(TextureFrame, OtherFacesBeginAtTheCorner) {
    const TextureFrame frame = boxFrame({});
    const TextureMap top = mapFace(&frame, {}, nullptr, true, {0, 1, 0}, {0, 1.5, 0});
    EXPECT_NEAR(uAt(top, {-3, 1.5, 2}), 0, 1e-12);
    EXPECT_NEAR(vAt(top, {-3, 1.5, 2}), 0, 1e-12);
    EXPECT_NEAR(vAt(top, {-3, 1.5, -2}), 4, 1e-12);
    const TextureMap curved = mapFace(&frame, {}, nullptr, false, {.1, .2, .9}, {0, 0, 2});
    EXPECT_NEAR(uAt(curved, {-3, -1.5, 2}), 0, 1e-12);
    const TextureMap skew = mapFace(&frame, {}, nullptr, true, normalized(Vec3d{1, 0, 1}), {0, 0, 0});
    EXPECT_NEAR(uAt(skew, {-3, 0, 2}), 0, 1e-12) << "no side looks there";
}

TEST(TextureFrame, FitsWholeTiles) {
    const TextureFrame frame = boxFrame({});
    Texture texture;
    texture.width_m = 1.5f, texture.height_m = .7f, texture.fits = true;
    const TextureMap map = mapFace(&frame, {}, &texture, true, {-1, 0, 0}, {-3, 0, 0});
    EXPECT_NEAR(uAt(map, {-3, 0, 2}) / 1.5, 13, 1e-6) << "20 m take 13 tiles";
    EXPECT_NEAR(vAt(map, {-3, 1.5, 2}) / .7, 4, 1e-6) << "3 m take 4";
    texture.width_m = 50;
    const TextureMap one = mapFace(&frame, {}, &texture, true, {0, 1, 0}, {0, 1.5, 0});
    EXPECT_NEAR(uAt(one, {3, 1.5, 0}) / 50, 1, 1e-6) << "at least one tile";
}

}  // namespace
}  // namespace sgm::image
