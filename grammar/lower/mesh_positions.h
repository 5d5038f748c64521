// The positions of a mesh's vertices by their numbers in the mesh.
// Enters: a mesh in chunks. Leaves: a list. Assumes that the mesh stays.
#pragma once

#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// By vertex of the mesh (mesh::Chunk::inMesh): where it is, metres. O(vertices).
inline std::vector<const Vec3f*> positionsOf(const mesh::Mesh& mesh) {
    std::vector<const Vec3f*> positions;
    positions.reserve(mesh.vertexCount());
    for (const mesh::Chunk& c : mesh.chunks)
        for (const Vec3f& p : c.positions) positions.push_back(&p);
    return positions;
}

}  // namespace sgm::lower
