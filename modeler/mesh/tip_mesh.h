// The mesh in which tips are looked for, as one list of vertices and one of triangles.
// Enters: a mesh in chunks. Leaves: its vertices, and the triangles near places. Assumes a mesh that stays as it is.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/parallel.h"
#include "modeler/core/progress.h"
#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/one_chunk.h"
#include "modeler/mesh/tip_fan.h"

namespace sgm::mesh {

/// The vertices and triangles of a mesh, counted across its chunks.
class TipMesh {
public:
    /// O(n); `mesh` has to stay. `threads` 0: all. Ticks once a chunk.
    TipMesh(const Mesh& mesh, int threads, Progress* progress);

    const PageVector<Vec3f>& positions() const { return positions_; }    ///< metres
    const PageVector<Vec3f>& normals() const { return normals_; }        ///< unit, at vertices without creases
    const std::vector<bool>& isConfined() const { return isConfined_; }  ///< by vertex: was kept in its cell
    const Chunk& chunk(size_t c) const { return mesh_.chunks[c]; }
    size_t chunkCount() const { return mesh_.chunks.size(); }

    /// Calls work(chunk's number) for every chunk, in no order.
    template <class Work>
    void inChunks(Work&& work) const {
        parallelFor(mesh_.chunks.size(), threads_, progress_, [&](size_t c, int) {
            work(c);
            tick(progress_);
        });
    }
    /// The triangles of all chunks that listIn(chunk's number, numbers) lists, in their order.
    template <class ListIn>
    std::vector<TipTriangle> trianglesOf(ListIn&& listIn) const {
        std::vector<std::vector<TipTriangle>> found(mesh_.chunks.size());
        inChunks([&](size_t c) {
            std::vector<uint32_t> numbers;
            listIn(c, numbers);
            for (const uint32_t t : numbers) found[c].push_back(triangleAt(c, t));
        });
        std::vector<TipTriangle> all;
        for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
        return all;
    }
    /// Those whose boxes meet some of the finder's, in their order. O(n / 64) where few do, after a first call in O(n).
    std::vector<TipTriangle> trianglesIn(const BoxFinder& finder);

private:
    static constexpr size_t runLength = 64;

    TipTriangle triangleAt(size_t c, uint32_t t) const;
    void findBoxesOfRuns();

    const Mesh& mesh_;
    const int threads_;
    Progress* const progress_;
    std::vector<uint32_t> firstTriangle_;  ///< by chunk
    PageVector<Vec3f> positions_, normals_;
    std::vector<bool> isConfined_;
    std::vector<std::vector<Box3f>> boxesOfRuns_;  ///< by chunk: around runs of its triangles, once they are asked for
};

}  // namespace sgm::mesh
