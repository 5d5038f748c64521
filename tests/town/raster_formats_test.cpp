#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <fstream>

#include "modeler/town/raster.h"
#include "tests/scratch.h"

namespace sgm::town {
namespace {

std::string bytesOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A picture of w × h floats in the channels, all the same.
std::string exrOf(int w, int h, const std::vector<float>& pixels, const std::vector<std::string>& channels,
                  bool tiled = false) {
    const Scratch folder;
    const std::string path = (folder.path() / "a.exr").string();
    Imf::Header header(w, h);
    Imf::FrameBuffer frame;
    for (const std::string& name : channels) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(pixels.data())),
                                      sizeof(float), sizeof(float) * static_cast<size_t>(w)));
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(2, 2));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(h);
    }
    return bytesOf(path);
}

struct Tiff {
    uint32_t width = 2, height = 2;
    uint16_t samples = 1, bits = 8, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK;
    uint32_t tile = 0;
    std::vector<double> scale{}, ties{};
    std::vector<uint16_t> keys{};
    std::string none{};

    std::string bytes(const void* pixels) const {
        static const TIFFFieldInfo geo[] = {
            {33550, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoPixelScale")},
            {33922, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoTiePoints")},
            {34735, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoKeyDirectory")},
            {42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoDataValue")}};
        const Scratch folder;
        const std::string path = (folder.path() / "a.tif").string();
        TIFF* file = TIFFOpen(path.c_str(), "w");
        TIFFMergeFieldInfo(file, geo, 4);
        TIFFSetField(file, TIFFTAG_IMAGEWIDTH, width);
        TIFFSetField(file, TIFFTAG_IMAGELENGTH, height);
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, samples);
        TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, format);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, photometric);
        TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(file, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
        if (!scale.empty()) TIFFSetField(file, 33550, static_cast<int>(scale.size()), scale.data());
        if (!ties.empty()) TIFFSetField(file, 33922, static_cast<int>(ties.size()), ties.data());
        if (!keys.empty()) TIFFSetField(file, 34735, static_cast<int>(keys.size()), keys.data());
        if (!none.empty()) TIFFSetField(file, 42113, none.c_str());
        const size_t pixel = size_t{samples} * bits / 8;
        const auto* from = static_cast<const unsigned char*>(pixels);
        if (tile > 0) {
            TIFFSetField(file, TIFFTAG_TILEWIDTH, tile);
            TIFFSetField(file, TIFFTAG_TILELENGTH, tile);
            for (uint32_t y = 0; y < height; y += tile)
                for (uint32_t x = 0; x < width; x += tile) {
                    std::vector<unsigned char> one(size_t{tile} * tile * pixel);
                    for (uint32_t k = 0; k < std::min(tile, height - y); ++k)
                        std::memcpy(one.data() + size_t{k} * tile * pixel, from + (size_t{y + k} * width + x) * pixel,
                                    std::min(tile, width - x) * pixel);
                    TIFFWriteTile(file, one.data(), x, y, 0, 0);
                }
        } else {
            for (uint32_t y = 0; y < height; ++y)
                TIFFWriteScanline(file, const_cast<unsigned char*>(from + size_t{y} * width * pixel), y, 0);
        }
        TIFFClose(file);
        return bytesOf(path);
    }
};

TEST(ExrMaps, SayTheirNumbersAsTheyAre) {
    const std::vector<float> relief{-3, 120.5f, 0, 88, 7, 9};
    for (const bool tiled : {false, true})
        for (const std::vector<std::string>& channels :
             {std::vector<std::string>{"Y"}, {"height"}, {"R", "G", "B"}, {"A", "Z"}}) {
            const auto read = readRasterBytes(exrOf(3, 2, relief, channels, tiled));
            ASSERT_TRUE(read.ok()) << read.error().message;
            EXPECT_EQ((*read)->width, 3u);
            EXPECT_NEAR((*read)->greyAt(1 / 6., .25), -3, 1e-4);
            EXPECT_NEAR((*read)->greyAt(.5, .25), 120.5, 1e-4);
            EXPECT_NEAR((*read)->greyAt(1 / 6., .75), 88, 1e-4);
            EXPECT_NEAR((*read)->greyAt(1 / 3., .25), (-3 + 120.5) / 2, 1e-4);
            EXPECT_FALSE((*read)->extent_m);
        }
}

TEST(ExrMaps, RefuseWhatIsDamagedOrTooLarge) {
    const std::vector<float> pixels(64, .5f);
    const std::string good = exrOf(8, 8, pixels, {"Y"});
    ASSERT_TRUE(readRasterBytes(good).ok());
    EXPECT_NE(readRasterBytes(good, {.mostSide = 7}).error().message.find("8 x 8"), std::string::npos);
    // The data window in the header alone says 2³⁰ pixels a side: nothing is allocated for it.
    std::string huge = good;
    const size_t window = huge.find("dataWindow");
    huge[window + 11 + 6 + 4 + 11] = 0x40;
    huge[window + 11 + 6 + 4 + 15] = 0x40;
    EXPECT_NE(readRasterBytes(huge).error().message.find("make it smaller"), std::string::npos)
        << readRasterBytes(huge).error().message;
    EXPECT_FALSE(readRasterBytes(good.substr(0, good.size() / 2)).ok());
    EXPECT_NE(readRasterBytes(exrOf(2, 2, pixels, {"A"})).error().message.find("alpha"), std::string::npos);
    for (size_t i = 0; i < good.size(); ++i)
        for (const int change : {1, 16, 128, 255}) {
            std::string bad = good;
            bad[i] = static_cast<char>(bad[i] ^ change);
            const auto read = readRasterBytes(bad, {.mostSide = 256, .mostPixels = 1 << 14});
            EXPECT_TRUE(!read.ok() || (*read)->numbers.size() == size_t{(*read)->width} * (*read)->height);
        }
}

TEST(TiffMaps, KeepGreyColoursAndNumbers) {
    const uint8_t grey[4] = {0, 64, 128, 255};
    const uint16_t fine[4] = {0, 1000, 30000, 65535};
    const int16_t metres[4] = {-12, 0, 431, 2962};
    const float floats[4] = {-1.5f, 2.25f, NAN, 1e6f};
    const uint8_t rgb[12] = {0x7f, 0xb2, 0xd9, 255, 255, 255, 0, 0, 0, 9, 9, 9};
    const auto at = [](const std::string& bytes, double u, double v) {
        const auto read = readRasterBytes(bytes);
        EXPECT_TRUE(read.ok()) << read.error().message;
        return read.ok() ? (*read)->greyAt(u, v) : -1;
    };
    EXPECT_NEAR(at(Tiff{}.bytes(grey), .75, .25), 64 / 255., 1e-4);
    EXPECT_NEAR(at(Tiff{.photometric = PHOTOMETRIC_MINISWHITE}.bytes(grey), .75, .25), 1 - 64 / 255., 1e-4);
    EXPECT_NEAR(at(Tiff{.bits = 16}.bytes(fine), .25, .75), 30000 / 65535., 1e-6);
    const std::string signedBytes = Tiff{.bits = 16, .format = SAMPLEFORMAT_INT}.bytes(metres);
    EXPECT_EQ(at(signedBytes, .25, .25), -12);
    EXPECT_EQ(at(signedBytes, .75, .75), 2962);
    const std::string floatBytes = Tiff{.bits = 32, .format = SAMPLEFORMAT_IEEEFP}.bytes(floats);
    EXPECT_EQ(at(floatBytes, .75, .25), 2.25);
    EXPECT_EQ(at(floatBytes, .25, .75), 0);  // what is no number
    const auto colours = readRasterBytes(Tiff{.samples = 3, .photometric = PHOTOMETRIC_RGB}.bytes(rgb));
    ASSERT_TRUE(colours.ok()) << colours.error().message;
    EXPECT_EQ((*colours)->colorAt(.25, .25), (std::array<uint8_t, 3>{0x7f, 0xb2, 0xd9}));
    EXPECT_EQ((*colours)->colorAt(.75, .75), (std::array<uint8_t, 3>{9, 9, 9}));
}

TEST(TiffMaps, OfTilesAreReadWhole) {
    std::vector<uint16_t> pixels(37 * 21);
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint16_t>(i * 83);
    const auto read = readRasterBytes(Tiff{.width = 37, .height = 21, .bits = 16, .tile = 16}.bytes(pixels.data()));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ((*read)->grey, pixels);
}

TEST(TiffMaps, SayTheirExtentByGeoTiff) {
    const float floats[4] = {1, -9999, 3, 4};
    Tiff map{.bits = 32,
             .format = SAMPLEFORMAT_IEEEFP,
             .scale = {30, 25, 0},
             .ties = {0, 0, 0, 691000, 5335000, 0},
             .keys = {1, 1, 0, 1, 1024, 0, 1, 1},
             .none = "-9999"};
    auto read = readRasterBytes(map.bytes(floats));
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_TRUE((*read)->extent_m);
    EXPECT_NEAR((*read)->extent_m->x, 60, 1e-9);
    EXPECT_NEAR((*read)->extent_m->z, 50, 1e-9);
    EXPECT_EQ((*read)->greyAt(.75, .25), 0);  // no data
    map.keys = {1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9002};
    EXPECT_NEAR((*readRasterBytes(map.bytes(floats)))->extent_m->x, 60 * .3048, 1e-9);
    // A second of arc at 48.1° north.
    map.keys = {1, 1, 0, 1, 1024, 0, 1, 2}, map.scale = {1 / 3600., 1 / 3600., 0}, map.ties = {0, 0, 0, 11.5, 48.1, 0};
    read = readRasterBytes(map.bytes(floats));
    EXPECT_NEAR((*read)->extent_m->x, 2 * 20.68, .02);
    EXPECT_NEAR((*read)->extent_m->z, 2 * 30.89, .02);
    map.scale = {};
    EXPECT_FALSE((*readRasterBytes(map.bytes(floats)))->extent_m);
}

TEST(TiffMaps, RefuseWhatIsDamagedOrTooLarge) {
    std::vector<uint8_t> pixels(64, 7);
    const std::string good =
        Tiff{.width = 8, .height = 8, .scale = {1, 1, 0}, .keys = {1, 1, 0, 0}}.bytes(pixels.data());
    ASSERT_TRUE(readRasterBytes(good).ok());
    EXPECT_NE(readRasterBytes(good, {.mostSide = 7}).error().message.find("8 x 8"), std::string::npos);
    EXPECT_FALSE(readRasterBytes(good.substr(0, 30)).ok());
    const std::string half =
        Tiff{.width = 4, .height = 4, .bits = 16, .format = SAMPLEFORMAT_IEEEFP}.bytes(pixels.data());
    EXPECT_NE(readRasterBytes(half).error().message.find("can't be read: save it as"), std::string::npos);
    for (size_t i = 0; i < good.size(); ++i)
        for (const int change : {1, 16, 128, 255}) {
            std::string bad = good;
            bad[i] = static_cast<char>(bad[i] ^ change);
            const auto read = readRasterBytes(bad, {.mostSide = 256, .mostPixels = 1 << 14});
            EXPECT_TRUE(!read.ok() || std::max((*read)->grey.size(), (*read)->numbers.size()) ==
                                          size_t{(*read)->width} * (*read)->height);
        }
}

}  // namespace
}  // namespace sgm::town
