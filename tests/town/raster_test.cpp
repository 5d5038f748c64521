#include <gtest/gtest.h>
#include <png.h>

#include "modeler/core/random.h"
#include "modeler/town/noise.h"
#include "modeler/town/raster.h"

namespace sgm::town {
namespace {

std::string pngOf(uint32_t width, uint32_t height, png_uint_32 format, const void* pixels) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = width, png.height = height, png.format = format;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = bytes.size();
    EXPECT_TRUE(png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels, 0, nullptr)) << png.message;
    bytes.resize(size);
    return bytes;
}

TEST(Rasters, KeepGreyOfEightAndSixteenBits) {
    const uint8_t grey[4] = {0, 64, 128, 255};
    const auto eight = readRasterBytes(pngOf(2, 2, PNG_FORMAT_GRAY, grey));
    ASSERT_TRUE(eight.ok()) << eight.error().message;
    EXPECT_NEAR((*eight)->greyAt(.25, .25), 0, 1e-3);
    EXPECT_NEAR((*eight)->greyAt(.75, .25), 64 / 255., 1e-3);
    EXPECT_NEAR((*eight)->greyAt(.25, .75), 128 / 255., 1e-3);
    EXPECT_NEAR((*eight)->greyAt(.5, .5), (64 + 128 + 255) / 4. / 255., 1e-3);
    EXPECT_NEAR((*eight)->greyAt(9, 9), 1, 1e-3);
    EXPECT_NEAR((*eight)->greyAt(-9, -9), 0, 1e-3);
    const uint16_t fine[4] = {0, 1000, 30000, 65535};
    const auto sixteen = readRasterBytes(pngOf(2, 2, PNG_FORMAT_LINEAR_Y, fine));
    ASSERT_TRUE(sixteen.ok()) << sixteen.error().message;
    EXPECT_NEAR((*sixteen)->greyAt(.75, .25), 1000 / 65535., 1e-5);
    EXPECT_NEAR((*sixteen)->greyAt(.25, .75), 30000 / 65535., 1e-5);
}

TEST(Rasters, KeepColours) {
    const uint8_t rgb[6] = {0x7f, 0xb2, 0xd9, 255, 255, 255};
    const auto read = readRasterBytes(pngOf(2, 1, PNG_FORMAT_RGB, rgb));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ((*read)->colorAt(.2, .5), (std::array<uint8_t, 3>{0x7f, 0xb2, 0xd9}));
    EXPECT_EQ((*read)->colorAt(.9, .5), (std::array<uint8_t, 3>{255, 255, 255}));
    EXPECT_NEAR((*read)->greyAt(1, .5), 1, 1e-3);
}

TEST(Rasters, RefuseWhatIsNoneOrTooLarge) {
    EXPECT_NE(readRasterBytes("").error().message.find("it is no picture"), std::string::npos);
    EXPECT_FALSE(readRasterBytes("GIF89a and so on, and so on, and so on").ok());
    const uint8_t grey[4] = {0, 64, 128, 255};
    const std::string good = pngOf(2, 2, PNG_FORMAT_GRAY, grey);
    std::string huge = good;
    huge[16] = 0x7f;  // the width in the header alone: nothing is allocated for it
    EXPECT_NE(readRasterBytes(huge).error().message.find("make it smaller"), std::string::npos);
    EXPECT_NE(readRasterBytes(good, {.mostSide = 1}).error().message.find("2 x 2"), std::string::npos);
    EXPECT_FALSE(readRasterBytes(good.substr(0, 40)).ok());
    // Any one byte changed: read or refused, never a crash.
    for (size_t i = 0; i < good.size(); ++i)
        for (const int change : {1, 128, 255}) {
            std::string bad = good;
            bad[i] = static_cast<char>(bad[i] ^ change);
            const auto read = readRasterBytes(bad);
            EXPECT_TRUE(!read.ok() || (*read)->grey.size() == size_t{(*read)->width} * (*read)->height);
        }
}

TEST(MapNoise, IsSmoothAndBounded) {
    double most = 0, sum = 0;
    for (uint64_t i = 0; i < 20000; ++i) {
        const plan::Vec2 p{uniform(combine(i, 1), -900, 900), uniform(combine(i, 2), -900, 900)};
        const double v = fbmNoise(p, 100, 3, 0);
        most = std::max(most, std::abs(v));
        sum += v;
        EXPECT_LT(std::abs(fbmNoise(p + plan::Vec2{.01, 0}, 100, 3, 0) - v), .002);
    }
    EXPECT_LE(most, 1);
    EXPECT_GT(most, .4);
    EXPECT_LT(std::abs(sum) / 20000, .05);
    EXPECT_EQ(bump({3, 4}, {0, 0}, 5), 0);
    EXPECT_EQ(bump({0, 0}, {0, 0}, 5), 1);
    EXPECT_EQ(bump({0, 0}, {0, 0}, 0), 0);
}

}  // namespace
}  // namespace sgm::town
