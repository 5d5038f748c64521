// The layers of a picture against the field itself, and their file as OpenEXR reads it again.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/scene.h"

namespace sgm::render::test {
namespace {

class LayersOf : public OnGpu {
protected:
    static constexpr int width = 96, height = 64;
    /// Two balls, origins 1 and 2, on the ground.
    void SetUp() override {
        OnGpu::SetUp();
        if (IsSkipped()) return;
        scene.add("sphere", {-1.2, 0, 0}, {1, 1, 1}, {0.7f, 0.1f, 0.1f});
        scene.add("sphere", {1.2, 0, 0}, {1, 1, 1}, {0.1f, 0.7f, 0.1f});
        field = scene.sum();
        options.width = width;
        options.height = height;
        options.camera = frame(field.bounds, double(width) / height);
        auto painter = FieldPainter::create(scene.compile(field), field.bounds, scene.provenance, 0, nullptr);
        ASSERT_TRUE(painter.ok()) << painter.error().message;
        const auto image = painter->draw(options, nullptr, &layers);
        ASSERT_TRUE(image.ok()) << image.error().message;
    }
    Scene scene;
    field::Field field;
    PictureOptions options;
    Layers layers;
};

TEST_F(LayersOf, AgreeWithTheFieldOnTheCpu) {
    const View view = viewOf(options.camera, width, height);
    size_t counts[3] = {0, 0, 0};
    for (size_t i = 0; i < layers.origin.size(); ++i) {
        const Vec3f p = layers.position[i], n = layers.normal[i];
        const auto origin = static_cast<OriginId>(layers.origin[i]);
        ASSERT_LE(origin, 2u);
        ++counts[origin];
        if (layers.depth[i] == Layers::farAway) {
            EXPECT_EQ(n, Vec3f{});
            continue;
        }
        EXPECT_NEAR(length(n), 1, 1e-3);
        // The pixel's ray passes the position at its depth.
        const double x = 2 * (double(i % width) + 0.5) / width - 1, y = 1 - 2 * (double(i / width) + 0.5) / height;
        const Vec3d ray = view.eye + (view.forward + view.right * x + view.up * y) * double(layers.depth[i]);
        EXPECT_LT(length(ray - p.as<double>()), 1e-3 * double(layers.depth[i]));
        if (origin == 0) {
            EXPECT_NEAR(p.y, field.bounds.lo.y, 1e-4) << "the ground";
            continue;
        }
        const Vec3f centre{origin == 1 ? -1.2f : 1.2f, 0, 0};
        const double facing = dot(n, normalized(view.eye - p.as<double>()).as<float>());
        // Rays stop at most .3 of a pixel before the surface and then go that far on.
        const double stop = 0.3 * view.pixelAngle * length(p.as<double>() - view.eye);
        EXPECT_NEAR(length(p - centre), 1, stop * (1 - facing) + 1e-4);
        if (facing > 0.3) {
            EXPECT_LT(length(n - normalized(p - centre)), 2e-2);
        }
        EXPECT_GE(layers.ao[i], 0);
        EXPECT_LE(layers.ao[i], 1);
    }
    for (const size_t count : counts) EXPECT_GT(count, 300u);
}

TEST_F(LayersOf, AreReadAgainFromTheirFile) {
    const auto path = std::filesystem::temp_directory_path() / ("sgm_layers_" + std::to_string(::getpid()) + ".exr");
    const Status written = writeExr(layers, layerNames(), {{"origins", "{\"1\":{}}"}}, path);
    ASSERT_TRUE(written.ok()) << written.error().message;
    {
        Imf::InputFile file(path.c_str());
        const auto* origins = file.header().findTypedAttribute<Imf::StringAttribute>("origins");
        ASSERT_TRUE(origins);
        EXPECT_EQ(origins->value(), "{\"1\":{}}");
        size_t channels = 0;
        for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) ++channels;
        EXPECT_EQ(channels, 12u);
        const size_t count = size_t(width) * height;
        std::vector<float> normalY(count), depth(count);
        Imf::FrameBuffer pixels;
        const auto want = [&](const char* name, std::vector<float>& into) {
            pixels.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(into.data()), 4, 4 * width));
        };
        want("normal.Y", normalY);
        want("depth.Z", depth);
        file.setFrameBuffer(pixels);
        file.readPixels(0, height - 1);
        EXPECT_EQ(depth, layers.depth);
        for (size_t i = 0; i < count; ++i) ASSERT_EQ(normalY[i], layers.normal[i].y);
    }
    EXPECT_FALSE(writeExr(layers, {"colour"}, {}, path).ok());
    EXPECT_FALSE(writeExr({}, {}, {}, path).ok());
    EXPECT_FALSE(writeExr(layers, {}, {}, path / "no" / "folder.exr").ok());
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace sgm::render::test
