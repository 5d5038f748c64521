// Picture files of textures: what is read of them, what is refused.
#include "modeler/image/image_file.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/image/pictures.h"
#include "tests/scratch.h"

namespace sgm::image {
namespace {

const std::vector<uint8_t> four{255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30};

TEST(ImageFiles, KeepTheBytesAndTellTheSize) {
    Scratch folder;
    for (const auto& [name, bytes, mime] :
         {std::tuple{"a.png", pngOf(2, 2, four), "image/png"}, std::tuple{"a.jpg", jpegOf(2, 2, four), "image/jpeg"}}) {
        folder.write(name, bytes);
        const auto file = readImageFile(folder / name);
        ASSERT_TRUE(file.ok()) << file.error().message;
        EXPECT_EQ((*file)->bytes, bytes);
        EXPECT_EQ((*file)->width, 2u);
        EXPECT_EQ((*file)->height, 2u);
        EXPECT_STREQ((*file)->mimeType(), mime);
        EXPECT_EQ((*file)->path.filename(), name);
        EXPECT_TRUE((*file)->path.is_absolute());
    }
}

TEST(ImageFiles, GiveTheirPixels) {
    const auto png = decode(**readImageBytes(pngOf(2, 2, four)));
    ASSERT_TRUE(png.ok());
    EXPECT_EQ(png->rgba[0], (std::array<uint8_t, 4>{255, 0, 0, 255}));
    EXPECT_EQ(png->rgba[3], (std::array<uint8_t, 4>{10, 20, 30, 255}));
    const auto jpeg = decode(**readImageBytes(jpegOf(16, 8, std::vector<uint8_t>(3 * 16 * 8, 90))));
    ASSERT_TRUE(jpeg.ok());
    ASSERT_EQ(jpeg->rgba.size(), 128u);
    for (const auto& p : jpeg->rgba)
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(p[c], 90, 2);
}

TEST(ImageFiles, RefuseWhatIsNoneTooLargeOrDamaged) {
    EXPECT_NE(readImageBytes("").error().message.find(".png or .jpg"), std::string::npos);
    EXPECT_FALSE(readImageBytes("GIF89a and so on, and so on").ok());
    EXPECT_NE(readImageBytes(pngOf(2, 2, four), {.mostSide = 1}).error().message.find("2 x 2 pixels"),
              std::string::npos);
    const auto missing = readImageFile("/no/such/picture.png");
    EXPECT_EQ(missing.error().message, "No such file or directory");
    std::vector<uint8_t> noisy(3 * 64 * 64);
    for (size_t i = 0; i < noisy.size(); ++i) noisy[i] = static_cast<uint8_t>(i * i * 31 >> 3);
    for (const std::string& whole : {pngOf(64, 64, noisy), jpegOf(64, 64, noisy)}) {
        const auto cut = readImageBytes(whole.substr(0, whole.size() / 2));
        EXPECT_FALSE(cut.ok() && decode(**cut).ok()) << "half of a file is no picture";
    }
}

/// Any byte changed: read or refused, never a crash.
TEST(ImageFiles, SurviveDamage) {
    std::vector<uint8_t> noisy(3 * 24 * 24);
    for (size_t i = 0; i < noisy.size(); ++i) noisy[i] = static_cast<uint8_t>(i * 37 >> 2);
    size_t read = 0;
    for (const std::string& whole : {pngOf(24, 24, noisy), jpegOf(24, 24, noisy)})
        for (size_t i = 0; i < whole.size(); i += 1 + i / 300)
            for (const int change : {1, 64, 255}) {
                std::string damaged = whole;
                damaged[i] = static_cast<char>(damaged[i] ^ change);
                const auto file = readImageBytes(damaged, {.mostSide = 4096});
                if (file.ok()) read += decode(**file).ok();
            }
    EXPECT_GT(read, 0u) << "some bytes are pixels";
}

}  // namespace
}  // namespace sgm::image
