// Level ground has two triangles a square of the grid; between its borders a few do.
// Enters: triangles with what they show. Leaves: the same surface in fewer triangles, so that a simplification, whose
// time grows with them, has less to do.
#pragma once

#include <span>
#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::tiles {

/// Triangles and, for each, a key: a border runs between those of unequal keys.
struct KeyedTriangles {
    std::vector<mesh::Triangle> triangles;
    std::vector<uint32_t> keys;
};

/// Triangulates each level region of one key anew, over the vertices of its border alone. A border between two level
/// regions loses vertices that lie straight between others, on both its sides; all other vertices of borders stay:
/// those of the list's own border and those that slopes share. A region whose border would cross itself stays as it is.
/// @param positions  metres, y up; numbered in the order in which the triangles name them first, for the result to
///     hang on the surface alone
/// @param rounding_m  heights that differ by less are level
/// @param tolerance_m  how far from its line a vertex may lie that a border loses
/// @return triangles that were kept, in their order, then those of regions. O(n log n).
KeyedTriangles mergeLevelRegions(const KeyedTriangles& ground, std::span<const Vec3f> positions, double rounding_m,
                                 double tolerance_m);

}  // namespace sgm::tiles
