// Triangles as a file gives them.
// Enters: what a reader found. Leaves: indexed triangles in double precision, in the file's own frame and unit. Assumes
// nothing of their shape: they may be open, flat, degenerate or the same twice.
#pragma once

#include <vector>

#include "modeler/core/vec.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

struct TriangleSoup {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside

    /// Around the triangles; vertices that none of them has don't count.
    Box3d bounds() const {
        Box3d box;
        for (const Triangle& t : triangles)
            for (int i = 0; i < 3; ++i) box = hull(box, positions[t[i]]);
        return box;
    }
};

}  // namespace sgm::mesh
