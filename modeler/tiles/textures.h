// Pictures that cover what a baked city shows: how they lie on triangles, and the files that hold them.
// Enters: parts with their materials. Leaves: axes of texture coordinates, picture files that all tiles share. Assumes
// that a picture's bytes name its file, so that several processes may write the same one at once.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/image/texture.h"

namespace sgm::tiles {

/// Directions in which texture coordinates grow over some triangles, and what they are at the origin.
struct TextureChart {
    Vec3f u, v;
    std::array<float, 2> origin{};

    /// Metres to the right and upwards.
    std::array<float, 2> at(Vec3f p) const { return {dot(p, u) + origin[0], dot(p, v) + origin[1]}; }
    /// To the right along the surface, for normal maps.
    Vec3f tangentAt(Vec3f normal) const;
};

/// The charts of a mesh, numbered as they come: a flat shape is mapped in its own planes, v along what its scope calls
/// up; a curved one as it is seen along the nearest axis of its scope.
class TextureCharts {
public:
    uint32_t of(const Part& part, Vec3f normal);
    const TextureChart& operator[](uint32_t chart) const { return charts_[chart]; }

private:
    std::vector<TextureChart> charts_;
};

/// The chart about another origin, `texture` having the same place there.
TextureChart movedTo(TextureChart chart, Vec3d origin, const image::Texture& texture);

/// The pictures of a texture that are there: colour, normals, roughness.
std::vector<image::ImageFilePtr> picturesOf(const image::Texture& texture);
/// The name of the file that holds a picture.
std::string fileNameOf(const image::ImageFile& picture);
/// Writes all pictures of the materials into a folder, where they aren't there yet.
Status writePictures(const std::vector<Material>& materials, const std::filesystem::path& folder);

/// What materials look like from afar, where a picture is a single colour: the mean of its pixels, linear.
class FarColors {
public:
    Vec3f of(const Material& material);

private:
    std::map<image::ImageFilePtr, Vec3f> known_;
};

}  // namespace sgm::tiles
