// Where every part of a field, and so every triangle, came from.
// Enters: ids set while lowering. Leaves: the shape, rule, line and material behind an id. Assumes id 0 means "none".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::image {
struct Texture;
struct TextureFrame;
}  // namespace sgm::image
namespace sgm {

/// Index into Provenance::parts; 0 is "nobody's" and stands for the whole object.
using OriginId = uint32_t;

/// How a terminal looks. Colours are linear RGB, 0 … 1.
struct Material {
    std::string name = "default";  ///< of what gives the look: a parameter, a terminal, or the colour itself
    Vec3f color{0.8f, 0.78f, 0.74f};
    float roughness = 0.8f;                         ///< 0 … 1
    float metallic = 0.0f;                          ///< 0 … 1
    std::shared_ptr<const image::Texture> texture;  ///< covers the surface; null: none
    friend bool operator==(const Material&, const Material&) = default;
};

/// How a shape stands in the object.
struct Pose {
    Vec3d origin;  ///< centre of its scope, metres
    Mat3 axes;     ///< of its scope: object from local
    friend bool operator==(const Pose&, const Pose&) = default;
};

/// One shape of the derived tree that owns surface.
struct Part {
    std::string path;           ///< path in the shape tree, "Cave/Cell[3]"
    std::string symbol;         ///< terminal or non-terminal name
    std::string rule;           ///< the rule application that made it, "" for the start
    std::string file;           ///< grammar file
    uint32_t line = 0;          ///< 1-based line of the text that made it
    uint32_t material = 0;      ///< index into Provenance::materials
    Pose pose;                  ///< of the shape's scope
    bool hasFlatFaces = false;  ///< its surface is made of planes, so that textures lie in them
    /// Where its textures begin; null: at the object's origin.
    std::shared_ptr<const image::TextureFrame> textureFrame;
};

/// The table behind OriginId and material indices. parts[0] and materials[0] always exist; no two materials look the
/// same.
struct Provenance {
    std::vector<Part> parts{Part{}};
    std::vector<Material> materials{Material{}};

    const Material& materialOf(OriginId id) const { return materials[parts[id < parts.size() ? id : 0].material]; }
};

}  // namespace sgm
