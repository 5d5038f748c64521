// What the readers of pictures share. For this folder's sources alone.
// Enters: bytes that somebody else made. Leaves: pixels, or the cause why not. Assumes nothing: sizes are judged by the
// header before anything is allocated.
#pragma once

#include <string>

#include "modeler/town/raster.h"

namespace sgm::town {

/// An error where a picture has no pixels, or more than the limits allow.
Status judgeSize(uint64_t width, uint64_t height, const RasterLimits& limits);
/// Rec. 709 luma of sRGB bytes as 0 … 65535.
uint16_t lumaOf(const std::array<uint8_t, 3>& color);

Result<RasterPtr> readPng(const std::string& bytes, const RasterLimits& limits);
/// Scan lines or tiles of one part, flat: its luminance or single channel, else the luma of its colours.
Result<RasterPtr> readExr(const std::string& bytes, const RasterLimits& limits);
/// 8-bit colours, grey of 8 and 16 bits, signed numbers and floats; with GeoTIFF's extent and its "no data".
Result<RasterPtr> readTiff(const std::string& bytes, const RasterLimits& limits);

bool isExr(const std::string& bytes);
bool isTiff(const std::string& bytes);

}  // namespace sgm::town
