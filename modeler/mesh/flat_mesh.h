// A mesh as plain arrays, without chunks.
// Enters: a Mesh. Leaves: its positions and triangles, vertices counted in the whole mesh. Assumes a numbered mesh.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Positions and triangles of a whole mesh, in the order of its chunks.
struct FlatMesh {
    /// Consecutive vertices and triangles that came from one chunk.
    struct Part {
        uint32_t firstVertex, vertices, firstTriangle, triangles;
    };
    PageVector<Vec3f> positions;     ///< metres
    PageVector<Triangle> triangles;  ///< corners count in `positions`
    PageVector<uint64_t> keys;       ///< by triangle: origin << 32 | label; 0 where the mesh has neither
    std::vector<Part> parts;

    static OriginId originOf(uint64_t key) { return static_cast<OriginId>(key >> 32); }
    static Label labelOf(uint64_t key) { return static_cast<Label>(key); }
};

/// Copies `mesh` into plain arrays on `threads` threads (0: all); O(n).
FlatMesh flatten(const Mesh& mesh, int threads);

/// The normal that `mesh`, whose flat form is `flat`, has for a vertex; corners may have others. O(log n) in the
/// chunks.
Vec3f normalOfVertex(const Mesh& mesh, const FlatMesh& flat, uint32_t vertex);

}  // namespace sgm::mesh
