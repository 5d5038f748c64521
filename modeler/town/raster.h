// Maps as pictures.
// Enters: PNG, OpenEXR and TIFF files that somebody else made. Leaves: pixels and what lies between them. Assumes
// nothing: sizes are judged by the header before anything is allocated.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::town {

/// A picture, row by row from its upper left corner: north-west, x east and z south.
struct Raster {
    uint32_t width = 0, height = 0;
    std::vector<uint16_t> grey;  ///< 0 … 65535: of grey pictures as they are, of coloured ones their luma
    std::vector<std::array<uint8_t, 3>> color;  ///< sRGB; empty where the picture has `numbers`
    std::vector<float> numbers;          ///< of pictures of floats and signed numbers, in place of `grey`: as they are
    std::optional<plan::Vec2> extent_m;  ///< the ground that the file says it covers, along x and z

    /// Grey from 0 to 1, or a number as it is, between the four nearest pixels, with (0, 0) the upper left corner of
    /// the picture and (1, 1) the lower right one; the border goes on outside.
    double greyAt(double u, double v) const;
    /// The colour of the pixel there; of pictures without colours grey, with 1 as white.
    std::array<uint8_t, 3> colorAt(double u, double v) const;
};
using RasterPtr = std::shared_ptr<const Raster>;

/// What is read at most.
struct RasterLimits {
    uint32_t mostSide = 32768;
    uint64_t mostPixels = 64ull << 20;
    uint64_t mostBytes = 512ull << 20;  ///< of the file
};

/// A PNG of 1 to 16 bits, a TIFF, or an OpenEXR picture, told by its first bytes. The error is the cause alone, for the
/// caller to name the file.
Result<RasterPtr> readRaster(const std::filesystem::path& path, const RasterLimits& limits = {},
                             const Progress* progress = nullptr);
/// Reads a PNG, TIFF or OpenEXR picture from memory. Error::Input and Error::Budget as readRaster().
Result<RasterPtr> readRasterBytes(const std::string& bytes, const RasterLimits& limits = {});

}  // namespace sgm::town
