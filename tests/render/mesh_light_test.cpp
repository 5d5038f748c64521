// Light on meshes: shadows of parts that are small beside the model, and light of the sky without traces of its maps.
#include <algorithm>
#include <cmath>

#include "tests/hard_box.h"
#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/mesh_scene.h"
#include "viewer/render/scene.h"

namespace sgm::render::test {
namespace {

class MeshLightPicture : public OnGpu {};

/// A picture of boxes, and what it shows.
struct Drawn {
    PictureOptions options;
    Image image;

    Drawn(std::vector<mesh::Chunk> boxes, const Camera& camera) {
        Scene scene;
        scene.origin({.6f, .6f, .6f});
        options.width = 480;
        options.height = 360;
        options.samples = 1;
        options.camera = camera;
        auto drawn = drawMesh(meshOfChunks(std::move(boxes)), scene.provenance, options, nullptr);
        EXPECT_TRUE(drawn.ok());
        if (drawn.ok()) image = std::move(*drawn);
    }
    /// The row and column of the pixel that shows a place.
    std::array<int, 2> pixelOf(Vec3d place) const {
        const View view = viewOf(options.camera, image.width, image.height);
        const Vec3d v = place - view.eye;
        const double depth = dot(v, view.forward);
        const double x = dot(v, view.right) / dot(view.right, view.right) / depth,
                     y = dot(v, view.up) / dot(view.up, view.up) / depth;
        return {static_cast<int>((1 - y) / 2 * image.height), static_cast<int>((x + 1) / 2 * image.width)};
    }
    /// The mean of the channels of 3 × 3 pixels.
    double brightness(int row, int column) const {
        double sum = 0;
        for (int y = row - 1; y <= row + 1; ++y)
            for (int x = column - 1; x <= column + 1; ++x)
                for (int k = 0; k < 3; ++k) sum += image.rgb[static_cast<size_t>((y * image.width + x) * 3 + k)];
        return sum / 27;
    }
    double brightness(Vec3d place) const {
        const auto [row, column] = pixelOf(place);
        return brightness(row, column);
    }
};

mesh::Chunk box(Vec3d low, Vec3d high) { return hardBox((low + high) / 2, {}, (high - low) / 2, 0); }

TEST_F(MeshLightPicture, ALintelOfALongWallHasItsShadow) {
    for (const double half : {10.0, 100.0}) {
        std::vector<mesh::Chunk> boxes{box({-half, -5, -.5}, {half, 5, .5})};
        for (int k = -3; k <= 3; ++k) boxes.push_back(box({3.0 * k - .8, 1.9, .5}, {3.0 * k + .8, 2.1, .725}));
        const Drawn wall(std::move(boxes), {{2, 1, 14}, {0, 1, 0}, .5});
        // The sun stands as high as 1.2 times as far before the wall: the shadow is .28 m long.
        const double sunny = wall.brightness(Vec3d{0, 1, .5});
        for (const double below : {.08, .14, .2})
            EXPECT_LT(wall.brightness(Vec3d{.1, 1.9 - below, .5}), .7 * sunny) << half << " m, " << below << " m below";
        EXPECT_GT(wall.brightness(Vec3d{.1, 1.5, .5}), .98 * sunny);
        EXPECT_GT(wall.brightness(Vec3d{.1, 2.25, .5}), .98 * sunny) << "above the lintel";
    }
}

/// The eye is far from the middle of a long box and near one of its corners, which lies aside of the view's middle.
TEST_F(MeshLightPicture, ACornerBesideTheEyeIsWhole) {
    const Drawn corner({box({-4, -1.125, -2.5}, {4, 1.125, 2.5})}, {{5.5, 1.3, 4.2}, {4, 0, 1}, .8});
    const double sunny = corner.brightness(Vec3d{3.85, .2, 2.5});
    for (const Vec3d place : {Vec3d{3.9, 1.05, 2.5}, {3.7, .95, 2.5}, {3.9, .9, 2.5}})
        EXPECT_NEAR(corner.brightness(place), sunny, .1 * sunny) << place.x << ' ' << place.y;
}

/// The sun's middle is hidden by the foot of the wall, and by a higher one before it.
TEST_F(MeshLightPicture, TheFootOfAThinWallHasNoSpeckOfSun) {
    std::vector<mesh::Chunk> walls{
        box({-4, -1.125, -2.5}, {-3.95, 1.125, 2.5}), box({3.95, -1.125, -2.5}, {4, 1.125, 2.5}),
        box({-3.95, -1.125, -2.5}, {3.95, 1.125, -2.45}), box({-3.95, -1.125, 2.45}, {3.95, 1.125, 2.5})};
    const Drawn court(std::move(walls), {{6.5, 3, 5.2}, {4, 0, 1}, .8});
    for (double z = -1.5; z < 1.8; z += .05) {
        const double here = court.brightness(Vec3d{4.1, -1.125, z}),
                     next = court.brightness(Vec3d{4.1, -1.125, z + .05});
        EXPECT_NEAR(here, next, 4) << z;
    }
}

/// Few directions of the sky show as rings on the ground.
TEST_F(MeshLightPicture, FineMeshesHaveDirectionsOfTheSkyEnough) {
    const auto gpu = GpuContext::create();
    ASSERT_TRUE(gpu.ok());
    EXPECT_GE(skyMapsFor(200'000, MeshScene::skyOfPictures), 40u);
    EXPECT_EQ(skyMapsFor(1'000, MeshScene::skyOfPictures), MeshScene::skyOfPictures.most);
    EXPECT_EQ(skyMapsFor(1'000'000'000, MeshScene::skyOfPictures), leastSkyMaps);
}

TEST_F(MeshLightPicture, LightOfTheSkyHasNoSteps) {
    // Two sides of a court with a roof on piers, in the shade, on a plate of 60 m.
    std::vector<mesh::Chunk> boxes{box({-30, -.4, -30}, {30, 0, 30}), box({-13.5, 0, -13}, {-13.1, 5.5, 13}),
                                   box({-13.1, 4.6, -13}, {-9.9, 5.5, 13}), box({9.9, 0, -13}, {13.5, 5.5, 13}),
                                   box({-13.1, 0, 12}, {9.9, 5.5, 13})};
    for (int k = -3; k <= 3; ++k) boxes.push_back(box({-10.3, 0, 3.6 * k - .3}, {-9.9, 4.6, 3.6 * k + .3}));
    const Drawn court(std::move(boxes), {{-4, 3.2, 4}, {-9.9, 2.6, 1}, .6});
    for (const double z : {-.1, .1}) {  // up a pier
        const auto [low, column] = court.pixelOf({-9.9, 1.2, z});
        const int high = court.pixelOf({-9.9, 4.2, z})[0];
        ASSERT_GT(low - high, 150);
        for (int row = high; row + 3 < low; ++row)
            EXPECT_NEAR(court.brightness(row, column), court.brightness(row + 3, column), 1.3) << "row " << row;
    }
}

}  // namespace
}  // namespace sgm::render::test
