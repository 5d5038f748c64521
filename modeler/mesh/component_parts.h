// The connected components of a mesh, chunk by chunk: for connected_components.cpp alone.
// Enters: a mesh. Leaves: which part each vertex is of, and what the parts join to. Assumes a mesh of Polygonize.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/chunk.h"
#include "modeler/mesh/components.h"
#include "modeler/mesh/connected_components.h"

namespace sgm::mesh::detail {

inline constexpr uint32_t none = SurfaceLabels::none;

/// A corner's place among a chunk's vertices, `own` of its own and then its ghosts.
constexpr uint32_t placeOf(uint32_t corner, uint32_t own) {
    return corner + ((0u - (corner >> 31)) & (own + ghostBit));  // without a branch that would be guessed wrong
}
constexpr Triangle placesOf(Triangle t, uint32_t own) {
    return {placeOf(t.x, own), placeOf(t.y, own), placeOf(t.z, own)};
}

inline uint32_t ownCount(const Chunk& c) { return static_cast<uint32_t>(c.positions.size()); }
inline size_t placeCount(const Chunk& c) { return c.positions.size() + c.ghosts.vertices.size(); }

/// Finds the chunks that own vertices; ghosts come in long runs of one owner.
class Owners {
public:
    explicit Owners(std::span<const Chunk> chunks) : chunks_(chunks) {}
    /// The number of the chunk that owns a vertex counted in the whole mesh.
    size_t of(uint32_t vertex) {
        if (vertex < begin_ || vertex >= end_) {
            const Chunk& owner = ownerOf(chunks_, vertex);
            at_ = static_cast<size_t>(&owner - chunks_.data());
            begin_ = owner.firstVertex, end_ = begin_ + ownCount(owner);
        }
        return at_;
    }

private:
    const std::span<const Chunk> chunks_;
    size_t at_ = 0;
    uint32_t begin_ = 0, end_ = 0;
};

/// What triangles of one part add up to.
struct Sum {
    uint64_t triangles = 0;
    double sixfold_m3 = 0;
    Box3d bounds;  ///< as seen from the mesh's first vertex
};

/// The same of the triangles that were given one label.
struct LabelSum {
    uint64_t triangles = 0;
    double sixfold_m3 = 0;
};

/// What hangs together among a chunk's triangles.
struct Parts {
    uint32_t first = 0;     ///< number of the first one in the mesh
    std::vector<Sum> sums;  ///< of each, in the order of their first triangles
    /// By place: the number of the vertex's part in the mesh, or none; empty where all are on the only one.
    PageVector<uint32_t> of;

    uint32_t at(size_t place) const { return of.empty() ? first : of[place]; }
};

/// Every connected surface, those around air too.
struct Surfaces {
    std::vector<ConnectedComponent> pieces;  ///< without their owners
    std::vector<Parts> parts;                ///< by chunk
    std::vector<uint32_t> pieceOf;           ///< by part
};

/// The components of a mesh; O(triangles), on so many threads.
Surfaces surfacesOf(const Mesh& mesh, int threads);

/// Finds the owners of each component, most triangles first.
void findOwners(const Mesh& mesh, Surfaces& surfaces);

}  // namespace sgm::mesh::detail
