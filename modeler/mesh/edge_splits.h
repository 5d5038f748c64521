// Edges of a mesh split in two.
// Enters: edges with where their middles go. Leaves: the mesh with those splits after which nothing crosses. Assumes a
// closed 2-manifold in one chunk that doesn't cross itself.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// An edge and what its middle becomes.
struct EdgeSplit {
    std::array<uint32_t, 2> halfEdges{};  ///< 3 · triangle + the corner that it begins at, in both triangles beside it
    Vec3f at;                             ///< metres
    std::array<Vec3f, 2> normals{};       ///< unit, of the vertex in either triangle and what becomes of it
};

/// A mesh whose edges are split, round by round.
class EdgeSplitter {
public:
    /// `threads` 0: all; results are the same for any number.
    EdgeSplitter(Chunk chunk, int threads, Progress* progress);

    const Chunk& chunk() const { return chunk_; }
    /// By triangle: the normals at its corners.
    std::span<const std::array<Vec3f, 3>> normals() const { return normals_; }
    /// The triangles that the last round made, ascending; at first all.
    std::span<const uint32_t> changed() const { return changed_; }

    /// Splits edges, each listed once, but for those of triangles that would fold over or cross others. A triangle
    /// with two or three of them becomes three or four. Returns how many were split; after cancelling none. O(n) for n
    /// triangles.
    size_t split(std::span<const EdgeSplit> splits);

    /// The mesh, without vertices that have no triangle. The splitter is of no use afterwards.
    Chunk take();

private:
    /// A triangle with its corners' normals, of those that come of a triangle that was there.
    struct Part {
        Triangle corners;
        std::array<Vec3f, 3> normals;
        uint32_t from;
    };
    struct Corner {
        uint32_t vertex = 0;
        Vec3f normal;
    };

    void listNormals();
    std::vector<Part> partsOf(std::span<const EdgeSplit> splits, uint32_t firstVertex);
    void addParts(uint32_t t, const std::array<Corner, 6>& corners, std::vector<Part>& parts) const;
    bool leaveOutFaulty(std::span<const Part> parts);
    bool isFolded(const Part& part) const;
    void replaceTriangles(std::span<const Part> parts);

    Chunk chunk_;
    const int threads_;
    Progress* const progress_;
    std::vector<std::array<Vec3f, 3>> normals_;
    std::vector<uint32_t> changed_;
    std::vector<bool> isLeftOut_;                    ///< by split
    std::vector<std::array<uint32_t, 3>> splitsOf_;  ///< by triangle: the splits of the edges behind its corners
};

}  // namespace sgm::mesh
