// What covers a surface again and again.
#pragma once

#include "modeler/image/image_file.h"

namespace sgm::image {

/// Pictures that repeat over a surface: v upwards as the scope of its shape, so many metres to a tile. A material's
/// colour, where it has none of these, stays as it is.
struct Texture {
    ImageFilePtr color;      ///< null: none
    ImageFilePtr normals;    ///< of the surface, in tangent space, y up (as glTF and OpenGL have it); null: none
    ImageFilePtr roughness;  ///< its green is the roughness, 0 … 1; null: none
    float width_m = 1, height_m = 1;  ///< of one tile
    bool fits = false;                ///< tiles are stretched so that whole numbers of them fill what they cover
    friend bool operator==(const Texture&, const Texture&) = default;
};

}  // namespace sgm::image
