// A picture as pixels, with the layers behind them, and its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm::render {

/// A picture: colours as sRGB.
struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  ///< width · height · 3, top row first
};

/// What the rays through the pixels' centres met, a value a pixel, top row first. Lengths in metres, object frame.
struct Layers {
    int width = 0, height = 0;
    std::vector<Vec3f> color;     ///< display light, linear, 0 … 1; smoothed like the picture
    std::vector<float> depth;     ///< from the eye along the viewing direction; `farAway` for the sky
    std::vector<Vec3f> normal;    ///< unit; 0 for the sky
    std::vector<Vec3f> position;  ///< 0 for the sky
    std::vector<float> origin;    ///< OriginId; 0 for sky and ground
    std::vector<float> ao;        ///< share of open sky, 0 … 1; 1 for the sky

    static constexpr float farAway = 1e10f;  ///< metres; what Blender writes where nothing is
};

/// The names of the layers that a file can hold beside the colour: depth, normal, position, origin, ao.
const std::vector<std::string>& layerNames();

/// PNG by libpng, written beside `path` and renamed into place.
Status writePng(const Image& image, const std::filesystem::path& path);

/// OpenEXR 2.0 with 32-bit floats: R, G, B and those of the layers, as depth.Z, normal.X, origin.V; `metadata` as text
/// attributes. Written beside `path` and renamed into place. Error::Usage for a name that no layer has.
Status writeExr(const Layers& layers, const std::vector<std::string>& names,
                const std::map<std::string, std::string>& metadata, const std::filesystem::path& path);

}  // namespace sgm::render
