// Where every part of a field, and so every triangle, came from.
// Enters: ids set while lowering. Leaves: the shape, rule, line and material behind an id. Assumes id 0 means "none".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modeler/core/pages.h"
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

/// Paths in a shape tree, by the number of the shape.
struct PartPaths {
    virtual ~PartPaths() = default;
    /// "Cave/Cell[3]". From any thread.
    virtual std::string of(uint32_t shape) const = 0;
};

/// A path in the shape tree: a text that is made on demand, for most paths of a
/// large model are never read.
class PartPath {
public:
    PartPath() = default;
    PartPath(std::string text);
    PartPath(const char* text) : PartPath(std::string(text)) {}
    PartPath(std::shared_ptr<const PartPaths> paths, uint32_t shape) : paths_(std::move(paths)), shape_(shape) {}
    /// O(depth of the shape).
    std::string text() const { return paths_ ? paths_->of(shape_) : std::string(); }
    operator std::string() const { return text(); }
    friend bool operator==(const PartPath& a, const PartPath& b) { return a.text() == b.text(); }
    friend bool operator==(const PartPath& a, const std::string& b) { return a.text() == b; }
    friend bool operator==(const PartPath& a, const char* b) { return a.text() == b; }

private:
    std::shared_ptr<const PartPaths> paths_;
    uint32_t shape_ = 0;
};

/// What of a grammar made a part; shared by all parts that the same text made.
struct PartSource {
    std::string symbol;  ///< terminal or non-terminal name
    std::string rule;    ///< the rule application that made it, "" for the start
    std::string file;    ///< grammar file
    uint32_t line = 0;   ///< 1-based line of the text that made it
    friend bool operator==(const PartSource&, const PartSource&) = default;
};
using PartSourcePtr = std::shared_ptr<const PartSource>;

/// One shape of the derived tree that owns surface.
struct Part {
    PartPath path;
    PartSourcePtr madeBy;       ///< null: nothing is known
    uint32_t material = 0;      ///< index into Provenance::materials
    bool hasFlatFaces = false;  ///< its surface is made of planes, so that textures lie in them
    Pose pose;                  ///< of the shape's scope
    /// Where its textures begin; null: at the object's origin.
    std::shared_ptr<const image::TextureFrame> textureFrame;

    const PartSource& source() const;
    const std::string& symbol() const { return source().symbol; }
    const std::string& rule() const { return source().rule; }
    const std::string& file() const { return source().file; }
    uint32_t line() const { return source().line; }
};

/// The table behind OriginId and material indices. parts[0] and materials[0] always exist; no two materials look the
/// same.
struct Provenance {
    std::vector<Part, ObjectPageAllocator<Part>> parts{Part{}};
    std::vector<Material> materials{Material{}};

    const Material& materialOf(OriginId id) const { return materials[parts[id < parts.size() ? id : 0].material]; }
};

}  // namespace sgm
