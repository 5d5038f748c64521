// Textures in pictures of fields: where their tiles lie, and what is seen from afar.
#include "modeler/image/texture.h"

#include "tests/image/pictures.h"
#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/surface_textures.h"

namespace sgm::render::test {
namespace {

image::Pixels pixels(uint32_t width, uint32_t height, const std::vector<std::array<uint8_t, 4>>& rgba) {
    return {width, height, rgba};
}

TEST(MipMaps, GiveThePixelsAndTheirMeans) {
    const MipMap map(pixels(2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}}),
                     MipMap::Values::Numbers);
    const auto expectColor = [&](double u, double v, Vec3f color, double footprint = 0) {
        const Vec3f at = map.at(u, v, footprint);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(at[c], color[c], 1e-4) << u << " " << v;
    };
    expectColor(.25, .75, {1, 0, 0});  // v upwards: the first row is above
    expectColor(.75, .75, {0, 1, 0});
    expectColor(.25, .25, {0, 0, 1});
    expectColor(-3.75, 6.25, {0, 0, 1});
    expectColor(.5, .75, {.5f, .5f, 0});
    expectColor(.1, .9, {.5f, .5f, .5f}, 2);
    expectColor(.1, .9, {.5f, .5f, .5f}, 100);
}

TEST(MipMaps, AverageTheLightOfColours) {
    const MipMap map(pixels(2, 1, {{255, 255, 255, 255}, {0, 0, 0, 255}}), MipMap::Values::Colors);
    EXPECT_NEAR(map.at(0, 0, 2).x, .5, 1e-3) << "half the light, which is 188 of 255 on a screen";
    EXPECT_NEAR(map.at(.25, 0, 0).x, 1, 1e-3);
}

class Textures : public OnGpu {
protected:
    /// A cube of 2 m; its tiles are red to the left and blue to the right, so wide.
    Result<Image> draw(float width_m, Vec3d turned = {}) {
        Scene scene;
        scene.add("cube", {0, 0, 0}, {1, 1, 1}, {.5f, .5f, .5f});
        auto texture = std::make_shared<image::Texture>();
        texture->color = *image::readImageBytes(image::pngOf(2, 1, {255, 0, 0, 0, 0, 255}));
        texture->width_m = width_m;
        scene.provenance.materials.back().texture = texture;
        scene.provenance.parts.back().hasFlatFaces = true;
        scene.provenance.parts.back().pose.axes = Mat3::rotation({0, 0, 1}, turned.z);
        const field::Field field = scene.sum();
        PictureOptions options;
        options.width = options.height = 96;
        options.camera = {{0, 0, 6}, {0, 0, 0}};
        options.ground = false;
        return drawField(scene.compile(field), field.bounds, scene.provenance, options, nullptr);
    }
    /// More red than blue there.
    static bool isRed(const Image& image, int x, int y) {
        const uint8_t* p = &image.rgb[3 * (static_cast<size_t>(y) * 96 + static_cast<size_t>(x))];
        EXPECT_GT(std::abs(p[0] - p[2]), 30) << x << " " << y;
        return p[0] > p[2];
    }
};

TEST_F(Textures, LieInMetresFromTheOrigin) {
    const auto image = draw(4);  // from the middle 2 m of red to the right, 2 m of blue to the left
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_TRUE(isRed(*image, 58, 48));
    EXPECT_FALSE(isRed(*image, 38, 48));
}

TEST_F(Textures, TurnWithTheScope) {
    const auto image = draw(4, {0, 0, 1.5707963});
    ASSERT_TRUE(image.ok());
    EXPECT_TRUE(isRed(*image, 48, 38)) << "u runs upwards now";
    EXPECT_FALSE(isRed(*image, 48, 58));
}

TEST_F(Textures, BecomeTheirMeanFromAfar) {
    const auto image = draw(.004f);
    ASSERT_TRUE(image.ok());
    const uint8_t* p = &image->rgb[3 * (48 * 96 + 48)];
    EXPECT_NEAR(p[0], p[2], 40) << "no stripes, half of each";
}

TEST_F(Textures, ADamagedPictureIsAnError) {
    std::vector<uint8_t> noisy(3 * 64 * 64);
    for (size_t i = 0; i < noisy.size(); ++i) noisy[i] = static_cast<uint8_t>(i * i >> 3);
    auto file = std::make_shared<image::ImageFile>(**image::readImageBytes(image::pngOf(64, 64, noisy)));
    file->bytes.resize(file->bytes.size() / 2);
    auto texture = std::make_shared<image::Texture>();
    texture->color = file;
    Provenance provenance;
    provenance.materials[0].texture = texture;
    const auto made = SurfaceTextures::create(provenance, nullptr);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("damaged"), std::string::npos);
}

}  // namespace
}  // namespace sgm::render::test
