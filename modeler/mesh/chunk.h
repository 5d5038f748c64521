// One block to its chunk, and chunks to a mesh.
// Enters: a block with its tape; the chunks of all blocks. Leaves: the chunk, which depends on nothing but its block
// and grid; vertices numbered across the mesh. Assumes all blocks with surface are there: an edge that the surface cuts
// is cut in every block around it, so the block that owns its vertex exists.
#pragma once

#include <optional>

#include "modeler/mesh/brick.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/vertices.h"

namespace sgm::mesh {

/// What one worker reuses from block to block.
class BlockMesher {
public:
    /// `refineSteps` as in findVertices.
    BlockMesher(const Grid& grid, size_t refineSteps) : grid_(grid), refineSteps_(refineSteps) {}

    /// The block's chunk; false when it was cancelled on the way. What it borrows is not named yet: see `link`.
    bool mesh(const Block& block, const Progress* progress, Chunk& chunk);

    /// Counts operations too, as eval::Workspace::tallyInto.
    void tallyInto(eval::Tally* tally) { workspace_.tallyInto(tally); }
    /// Counted so far; seconds are those of this worker.
    const Counts& counts() const { return counts_; }

private:
    /// A cell with surface, by its low corner.
    struct Cell {
        uint16_t corner;
        uint8_t inside;  ///< which corners are, a case of marching cubes
    };
    /// A brick with surface, its cells up to `cellsEnd`.
    struct Brick {
        size_t cellsEnd;
        std::optional<OriginId> owner;  ///< of all its triangles, where that is one
    };
    /// A cut edge of another block.
    struct Borrowed {
        uint32_t edge;  ///< in number_
        OriginId origin;
    };

    void clear();
    void addBrick(int number, const eval::Tape& tape);
    template <int axis>
    void addEdges(const BitRows& inside, Vec3i brick, std::optional<OriginId> owner, size_t& n);
    uint32_t borderVertex(int edge, int lowSides, int highSides, OriginId owner);
    void addVertices(const eval::Tape& tape, std::optional<OriginId> owner);
    void listSeams(Chunk& chunk);
    void writeTriangles(Chunk& chunk) const;
    OriginId originOf(uint32_t corner) const {
        return corner & borrowedBit ? borrowedOrigins_[corner & ~borrowedBit] : origins_[corner];
    }

    const Grid grid_;
    const size_t refineSteps_;
    eval::Workspace workspace_;
    BlockSamples samples_;
    CutEdges edges_;
    std::vector<CutEdges> openEdges_;
    PageVector<uint32_t> number_ =
        PageVector<uint32_t>(3 * cornersPerBlock);  ///< of the vertex on an edge, see edgePlace
    PageVector<Vec3f> positions_, normals_;
    PageVector<OriginId> origins_, borrowedOrigins_, found_;
    PageVector<Cell> cells_ = PageVector<Cell>(blockCells * blockCells * blockCells);  ///< the first cellCount_ count
    std::vector<Brick> bricks_;
    std::array<std::vector<Borrowed>, seamKinds> borrowed_;
    std::array<std::vector<uint32_t>, seamKinds> lent_;
    uint32_t vertices_ = 0;
    size_t cellCount_ = 0, triangles_ = 0;
    bool flat_ = false;  ///< some vertex has no normal
    Counts counts_;
};

/// Numbers the vertices of chunks in order of (z, y, x) across the mesh and gives those without derivative the mean of
/// their triangles' normals. To be called again after any chunk was exchanged. Error::Budget for 2³² vertices or
/// triangles.
Status link(std::vector<Chunk>& chunks, int threads);

}  // namespace sgm::mesh
