// Fog: depths against closed forms, and pictures in which it is where it should be.
#include <cmath>

#include "tests/render/gpu_fixture.h"
#include "viewer/render/draw.h"
#include "viewer/render/fog_light.h"

namespace sgm::render::test {
namespace {

/// `value(p)` on n³ voxels of a cube about the origin with half edge 1.
template <class F>
volume::Dense cube(int n, F&& value) {
    volume::Dense grid;
    grid.count = {n, n, n};
    grid.voxel_m = 2.0f / static_cast<float>(n);
    const float half = grid.voxel_m / 2;
    grid.low = Vec3f{-1, -1, -1} + Vec3f{half, half, half};
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                grid.values.push_back(value(grid.low + Vec3f{float(x), float(y), float(z)} * grid.voxel_m));
    return grid;
}

/// A ball of radius 0.8 whose edge is 0.15 deep.
volume::Dense ball(int n) {
    return cube(n, [](Vec3f p) { return std::clamp((0.8f - length(p)) / 0.15f, 0.0f, 1.0f); });
}

TEST(FogLight, DepthIsThatOfTheChord) {
    const volume::Dense grid = cube(48, [](Vec3f p) { return length(p) < 0.8f ? 1.0f : 0.0f; });
    for (const Vec3f direction :
         {Vec3f{0, 1, 0}, Vec3f{-1, 0, 0}, normalized(Vec3f{-0.4f, 0.7f, 0.6f}), normalized(Vec3f{1, -1, 0.2f})}) {
        const std::vector<float> depth = opticalDepth(grid, direction, 2);
        for (int i = 4; i < 44; i += 5) {
            const Vec3f p = grid.low + Vec3f{float(i), float(47 - i), float(i / 2 + 12)} * grid.voxel_m;
            if (length(p) > 0.6f) continue;
            const float along = dot(p, direction), chord = -along + std::sqrt(0.64f - dot(p, p) + along * along);
            EXPECT_NEAR(depth[grid.index(i, 47 - i, i / 2 + 12)], chord, 0.05f);
        }
    }
}

TEST(FogLight, IsTheSameOnAnyNumberOfThreads) {
    const volume::Dense grid = ball(20);
    const auto one = lightFog(grid, 20, 0.4f, {0, 1, 0}, 1, nullptr),
               three = lightFog(grid, 20, 0.4f, {0, 1, 0}, 3, nullptr);
    ASSERT_TRUE(one.ok() && three.ok());
    EXPECT_EQ(one->rgba, three->rgba);
    const auto at = [&](int y, int channel) { return one->rgba[grid.index(10, y, 10) * 4 + size_t(channel)]; };
    EXPECT_LT(at(15, 1), at(5, 1)) << "less fog before the sun above than below";
    EXPECT_GT(at(15, 2), at(5, 2)) << "more sky";
    EXPECT_LT(at(15, 3), at(5, 3)) << "less of what lies below";
    Progress progress;
    progress.cancel();
    EXPECT_EQ(lightFog(grid, 20, 0.4f, {0, 1, 0}, 1, &progress).error().kind, Error::Kind::Cancelled);
}

TEST(FogLight, BricksSayHowFarFogIs) {
    const volume::Dense grid = cube(64, [](Vec3f p) {
        return length(p - Vec3f{-0.9f, -0.9f, -0.9f}) < 0.05f ? 1.0f : 0.0f;
    });
    const auto texels = lightFog(grid, 1, 0.4f, {0, 1, 0}, 0, nullptr);
    ASSERT_TRUE(texels.ok());
    ASSERT_EQ(texels->brickCount, (Vec3i{8, 8, 8}));
    EXPECT_EQ(texels->bricks[0], 0);
    EXPECT_EQ(texels->bricks[3], 3);
    EXPECT_EQ(texels->bricks[511], 7);
}

TEST(FogLight, BillowsTileAndUseTheirRange) {
    const std::vector<uint8_t> tile = billows(32);
    EXPECT_EQ(tile, billows(32));
    const auto [low, high] = std::minmax_element(tile.begin(), tile.end());
    EXPECT_GT(*high - *low, 80);
    double seam = 0, inside = 0;
    for (size_t row = 0; row < 32 * 32; ++row) {
        seam += std::abs(tile[row * 32] - tile[row * 32 + 31]);
        inside += std::abs(tile[row * 32 + 15] - tile[row * 32 + 16]);
    }
    EXPECT_LT(seam, 1.5 * inside);
}

class Fog : public OnGpu {
protected:
    Result<Image> draw(float extinction_per_m, bool ground = false, Progress* progress = nullptr) {
        PictureOptions options;
        options.width = options.height = 96;
        options.camera = {ground ? Vec3d{0, 5, 4} : Vec3d{0, 0.3, 6}, {0, 0, 0}};
        options.ground = ground;
        auto painter = FogPainter::create(ball(40), {{-0.8f, -0.8f, -0.8f}, {0.8f, 0.8f, 0.8f}},
                                          {extinction_per_m, 1.2f}, 0, nullptr);
        if (!painter.ok()) return painter.error();
        return painter->draw(options, progress);
    }
    static std::array<int, 3> at(const Image& image, int x, int y) {
        const uint8_t* p = &image.rgb[(size_t(y) * size_t(image.width) + size_t(x)) * 3];
        return {p[0], p[1], p[2]};
    }
};

TEST_F(Fog, IsWhiteWhereItIsThickAndSkyBesideIt) {
    const auto thick = draw(60), none = draw(1e-6f);
    ASSERT_TRUE(thick.ok() && none.ok()) << thick.error().message;
    const auto middle = at(*thick, 44, 40), sky = at(*none, 44, 40);
    EXPECT_GT(middle[0], 190);
    EXPECT_LT(middle[2] - middle[0], 25) << "white";
    EXPECT_GT(sky[2] - sky[0], 40) << "blue";
    for (const auto& [x, y] : {std::pair{3, 3}, std::pair{92, 50}, std::pair{48, 93}})
        EXPECT_EQ(at(*thick, x, y), at(*none, x, y));
    // The sun stands high: the ball is darker below.
    EXPECT_GT(at(*thick, 44, 36)[0], at(*thick, 56, 66)[0] + 15);
}

TEST_F(Fog, ThinFogLetsTheSkyThrough) {
    const auto thick = draw(60), thin = draw(0.4f), none = draw(1e-6f);
    ASSERT_TRUE(thick.ok() && thin.ok() && none.ok());
    const auto blueness = [](const Image& image) { return at(image, 48, 48)[2] - at(image, 48, 48)[0]; };
    EXPECT_LT(blueness(*thick) + 5, blueness(*thin));
    EXPECT_LT(blueness(*thin) + 5, blueness(*none));
}

TEST_F(Fog, CastsShadowAndIsTheSameTwice) {
    const auto one = draw(60, true), two = draw(60, true), none = draw(1e-6f, true);
    ASSERT_TRUE(one.ok() && two.ok() && none.ok());
    EXPECT_EQ(one->rgb, two->rgb);
    int darker = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) darker += at(*one, x, y)[0] + 20 < at(*none, x, y)[0] ? 1 : 0;
    EXPECT_GT(darker, 20);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(draw(60, true, &progress).error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sgm::render::test
