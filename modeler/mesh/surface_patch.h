// A part of a surface, to be exchanged without looking at the rest.
// Enters: a surface of one chunk and some of its triangles. Leaves: these as a surface of their own, and the whole
// surface with others in their place.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Some of a surface's triangles, in their order and with their vertices.
struct SurfacePatch {
    Chunk surface;
    std::vector<uint32_t> vertices, triangles;  ///< their numbers in the whole surface, ascending

    /// Some triangles, ascending, of a surface of one chunk. O(n) in the patch, and in the whole surface's vertices.
    SurfacePatch(const Chunk& whole, std::vector<uint32_t> some);
};

/// What comes in a patch's place: a surface whose first vertices are the patch's, in their order, and whose first
/// triangles stand for some of the patch's.
struct ReplacedPatch {
    Chunk surface;
    std::vector<uint32_t> triangleOf;  ///< by triangle of the first ones: the one of the patch, in ascending order
};

/// The whole surface with a replaced patch: triangles in the place of those that they stand for, and new ones behind
/// all others, as new vertices are. Vertices without triangles are left out. O(n) in the whole.
Chunk withReplaced(const Chunk& whole, const SurfacePatch& patch, const ReplacedPatch& replaced);

}  // namespace sgm::mesh
