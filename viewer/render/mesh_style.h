// How a mesh is coloured and cut in pictures.
#pragma once

#include <optional>

#include "modeler/core/vec.h"

namespace sgm::render {

/// What the mesh's colour says. Labels: a hue for each smooth piece; Creases: grey, with hard edges drawn.
enum class MeshLook { Materials, Normals, Curvature, Origin, Components, Labels, Creases };

/// Everything on the side of a plane that its normal points to is cut away.
struct Section {
    Vec3f normal{1, 0, 0};  ///< unit
    float offset = 0;       ///< metres along the normal from the origin
    friend bool operator==(const Section&, const Section&) = default;
};

struct MeshStyle {
    MeshLook look = MeshLook::Materials;
    bool wireframe = false;
    std::optional<Section> section;
    friend bool operator==(const MeshStyle&, const MeshStyle&) = default;
};

}  // namespace sgm::render
