// One block to its chunk, and chunks to a mesh.
// Enters: a block with its tape; the chunks of all blocks. Leaves: the chunk, which depends on nothing but its block
// and grid; vertices numbered across the mesh. Assumes all blocks with surface are there: an edge that the surface cuts
// is cut in every block around it, so the block that owns its vertex exists.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "modeler/mesh/brick.h"
#include "modeler/mesh/crisp_block.h"
#include "modeler/mesh/flat_cells.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/vertices.h"

namespace sgm::mesh {

/// The sides of a block that a brick touches, as a mask of axes.
constexpr int lowSidesOf(Vec3i brick) {
    return (brick.x == 0 ? 1 : 0) | (brick.y == 0 ? 2 : 0) | (brick.z == 0 ? 4 : 0);
}
constexpr int highSidesOf(Vec3i brick) { return lowSidesOf(Vec3i{1, 1, 1} * (bricksAlong - 1) - brick); }

/// What one worker reuses from block to block; aligned, so that no two workers write to one line of cache, nor to the
/// next one, which processors fetch with it.
class alignas(128) BlockMesher {
public:
    BlockMesher(const Grid& grid, const PolygonizeOptions& options);

    /// The block's chunk; false when it was cancelled on the way. Its ghosts are not numbered yet: see `link`.
    bool mesh(const Block& block, const Progress* progress, Chunk& chunk);

    /// Counts operations too, as eval::Workspace::tallyInto.
    void tallyInto(eval::Tally* tally) { workspace_.tallyInto(tally); }
    /// Reads the clock around all that evaluates the field.
    void timeField() { fieldTime_ = &counts_.field; }
    /// Counted so far; seconds are those of this worker.
    const Counts& counts() const { return counts_; }

private:
    /// A brick with surface, its triangles up to `trianglesEnd`.
    struct Brick {
        size_t trianglesEnd;
        std::optional<OriginId> owner;  ///< of all its triangles, where that is one
    };
    /// A cut edge of another block.
    struct GhostVertex {
        uint32_t edge;  ///< in number_
        OriginId origin;
        PiecePoint point{};  ///< of a crisp surface
    };

    /// Bricks with surface, by number: which there are, of which all edges have one owner, and who that is.
    struct Owned {
        uint64_t bricks = 0, alike = 0;
        std::array<OriginId, bricksPerBlock> owner;
    };

    struct CutEdgesOfBrick {
        CutEdges edges;  ///< its own first; before them those that wait
        size_t own = 0;
        size_t waiting = 0;  ///< edges of bricks before, whose vertices the block's whole tape is still to find
        std::vector<CutEdges> open;
        std::vector<std::pair<int, size_t>> borrowed;  ///< of the others: kind of seam, place in its list
    };
    struct Vertices {
        /// Of the vertex on an edge, see edgePlace; the last ones are read and never used.
        PageVector<uint32_t> number = PageVector<uint32_t>(3 * cornersPerBlock + rowPadding);
        PageVector<Vec3f> positions, normals;
        PageVector<OriginId> origins;  ///< at last the origins of ghosts come after those of the own
        PageVector<uint32_t> labels;   ///< of a crisp surface, as origins
        uint32_t count = 0;
        bool flat = false;  ///< some vertex has no normal
    };
    /// What the field says at the vertices of a brick.
    struct Found {
        PageVector<OriginId> origins;
        PageVector<uint32_t> labels;
    };
    struct Cells {
        PageVector<SurfaceCell> list =
            PageVector<SurfaceCell>(blockCells * blockCells * blockCells + rowPadding);  ///< the first `count` count
        size_t count = 0, triangles = 0;
        std::unique_ptr<FlatCells> flat;  ///< null where they stay as they are
    };
    /// What other blocks share.
    struct Seams {
        std::array<std::vector<GhostVertex>, seamKinds> ghosts;
        std::array<std::vector<uint32_t>, seamKinds> shared;
    };

    void clear();
    const eval::Tape& sampled(int brick);
    std::optional<OriginId> onlyOwner(const eval::Tape& tape) const;
    void addBrick(int number, const eval::Tape& tape, const Block& block);
    bool addCells(const BrickSigns& signs, Vec3i brick, const PartOfBlock* part);
    void addOwnEdges(const BrickSigns& signs);
    void addGhosts(const BrickSigns& signs, Vec3i brick, std::optional<OriginId> owner);
    void placeEdges(Vec3i brick);
    void addShared(const BrickSigns& signs, Vec3i brick);
    void findPlaces(const eval::Tape& tape, size_t own);
    void findWaiting(const eval::Tape& tape);
    std::optional<OriginId> findOrigins(const eval::Tape& tape);
    void addCrispBrick(Vec3i brick, const BrickSigns& signs, const eval::Tape& tape);
    void findLabels(const eval::Tape& tape);
    void splitAtCreases(const Block& block, Chunk& chunk);
    void takeSplit(Chunk& chunk) const;
    void listFaceSeams(Chunk& chunk) const;
    std::optional<OriginId> ownerAround(Vec3i brick, OriginId owner) const;
    void listSeams(Chunk& chunk);
    void writeTriangles(Chunk& chunk) const;

    const Grid grid_;
    const size_t refineSteps_;
    const bool bare_;
    std::unique_ptr<CrispBlock> crisp_;  ///< null for plain marching cubes
    eval::Workspace workspace_;
    BlockSamples samples_;
    CutEdgesOfBrick cut_;
    Vertices vertices_;
    Found found_;
    Cells cells_;
    std::vector<Brick> bricks_;
    Owned owned_;
    Seams seams_;
    Counts counts_;
    SumOfTimes* fieldTime_ = nullptr;  ///< counts_.field, if that is measured
};

/// Counts vertices and triangles across a mesh. Chunks come in order of (z, y, x).
struct Numbering {
    uint64_t vertices = 0, triangles = 0;
    /// The next chunks. Error::Budget for 2³² vertices or triangles.
    Status add(std::span<Chunk> chunks);
};

/// The chunk that owns a vertex counted in the whole mesh; `chunks`, numbered and in order, hold it.
const Chunk& ownerOf(std::span<const Chunk> chunks, uint32_t vertex);

/// Numbers the ghosts of a chunk; `chunks`, numbered and in order, hold their owners.
void numberGhosts(std::span<const Chunk> chunks, Chunk& chunk);

/// Gives vertices of `of` without derivative the mean of their triangles' normals, weighted by area. `chunks`, named
/// and in order, hold `of`, all that have ghosts of its vertices and all whose vertices it has ghosts of.
void setFacetedNormals(std::span<const Chunk> chunks, std::span<Chunk> of);

/// All of that for a whole mesh. To be called again after any chunk was exchanged. Error::Budget for 2³² vertices or
/// triangles.
Status link(std::vector<Chunk>& chunks, int threads);

}  // namespace sgm::mesh
