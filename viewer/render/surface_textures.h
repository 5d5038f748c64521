// Textures as pictures of fields show them.
// Enters: what covers the parts, a place on one of them. Leaves: its colour, roughness and normal. Needs no GPU.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/image/texture.h"

namespace sgm::render {

/// A picture in halved sizes (mip maps, Williams 1983), each value from 0 to 1.
class MipMap {
public:
    enum class Values : uint8_t { Colors, Numbers };  ///< of colours light is averaged, of numbers themselves
    MipMap() = default;
    MipMap(image::Pixels pixels, Values values);

    uint32_t width() const { return levels_[0].width; }
    uint32_t height() const { return levels_[0].height; }
    /// The mean over so many of its pixels in a square about (u, v), which are shares of the picture, v upwards; it
    /// repeats. Between the four nearest pixels of the two nearest sizes.
    Vec3f at(double u, double v, double side_px) const;

private:
    struct Level {
        uint32_t width = 0, height = 0;
        std::vector<std::array<uint16_t, 3>> pixels;
    };
    static Vec3f sample(const Level& level, double u, double v);

    std::vector<Level> levels_;  ///< the largest first
};

/// What a surface is like at a place.
struct SurfaceLook {
    Vec3f color;
    float roughness = 0, metallic = 0;
    Vec3f normal;  ///< unit
};

/// The textures of a model, ready to be asked.
class SurfaceTextures {
public:
    /// Decodes every picture once. Error::Input for one that is damaged, Error::Cancelled.
    static Result<SurfaceTextures> create(const Provenance& provenance, Progress* progress);

    /// False where no part has a texture.
    bool any() const { return !textures_.empty(); }
    /// True when the part has one.
    bool covers(OriginId origin) const { return origin < parts_.size() && parts_[origin].texture != nullptr; }
    /// Changes `look` at a place on a part that is covered; `footprint_m` is the side of the area that a pixel sees.
    void apply(OriginId origin, Vec3f position, double footprint_m, SurfaceLook& look) const;

private:
    struct Texture {
        std::shared_ptr<const MipMap> color, normals, roughness;
        double width_m = 1, height_m = 1;
    };
    struct CoveredPart {
        std::shared_ptr<const Texture> texture;
        std::shared_ptr<const image::TextureFrame> frame;
        const image::Texture* looks = nullptr;
        Mat3 axes;
        bool flat = false;
    };
    std::map<std::shared_ptr<const image::Texture>, std::shared_ptr<const Texture>> textures_;
    std::vector<CoveredPart> parts_;  ///< by OriginId
};

}  // namespace sgm::render
