// A mesh whose triangles are exchanged in part.
// Enters: a mesh. Leaves: its one chunk, to be changed.
#pragma once

#include <algorithm>
#include <span>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Adds a chunk's vertices behind those that `whole` has, which are to be as many as its `firstVertex` says.
void appendVertices(Chunk& whole, const Chunk& chunk);
/// Adds a chunk's triangles; `whole` has, or gets, all vertices by their numbers in the mesh.
void appendTriangles(Chunk& whole, const Chunk& chunk);
/// All that a mesh has in one chunk, in its order. O(n).
Chunk joinChunks(const Mesh& mesh);

/// Leaves out vertices that have no triangle; the others keep their order. O(n).
void dropUnusedVertices(Chunk& chunk);

/// Calls visit(triangle, its corner normals) for every triangle of a chunk.
template <class Visit>
void visitTriangles(const Chunk& chunk, Visit&& visit) {
    const std::span<const CornerNormal> all(chunk.cornerNormals);
    size_t first = 0;
    for (uint32_t t = 0; t < chunk.triangles.size(); ++t) {
        size_t end = first;
        while (end < all.size() && all[end].corner / 3 == t) ++end;
        visit(t, all.subspan(first, end - first));
        first = end;
    }
}

/// The corner normals of one triangle of a chunk. O(log n).
inline std::span<const CornerNormal> cornerNormalsOf(const Chunk& chunk, uint32_t triangle) {
    const auto isBefore = [](const CornerNormal& n, uint32_t corner) { return n.corner < corner; };
    const auto begin = std::lower_bound(chunk.cornerNormals.begin(), chunk.cornerNormals.end(), 3 * triangle, isBefore);
    return {begin, std::lower_bound(begin, chunk.cornerNormals.end(), 3 * triangle + 3, isBefore)};
}

}  // namespace sgm::mesh
