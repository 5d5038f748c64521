// A block's surface with its creases: cells in which all is one smooth piece keep the triangles of marching cubes, the
// others are split along creases and borders.
// Enters: the vertices of marching cubes with their labels. Leaves: triangles, new vertices, and which of them blocks
// share. Assumes labels and places that blocks around an edge agree on, bit by bit.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/cell_pieces.h"
#include "modeler/mesh/marching_cubes.h"
#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {

/// What marching cubes found in a block. Vertices are own ones by number, then ghosts.
struct BlockSurface {
    const Block* block;
    BlockTapes tapes;
    const Grid* grid;
    std::span<const SurfaceCell> cells;
    const uint32_t* number;  ///< of the vertex on an edge, by 3 · corner + axis
    uint32_t own;            ///< vertices of the block
    std::span<const Vec3f> positions, normals;
    std::span<const uint32_t> labels;
    std::span<const OriginId> origins;
    std::span<const Triangle> triangles;  ///< cell by cell

    /// A corner's place in the lists.
    uint32_t placeOf(uint32_t corner) const { return corner & ghostBit ? own + (corner & ~ghostBit) : corner; }
};

/// One worker's, reused from block to block.
class CrispBlock {
public:
    /// Finds creases and splits cells. Returns how often the field was evaluated.
    uint64_t run(const BlockSurface& surface, eval::Workspace& workspace);
    /// Whether anything was split. What follows is empty else.
    bool hasCreases() const { return !mixed_.empty(); }
    /// The block's triangles with their labels, origins and corner normals; new own vertices.
    const PieceTriangles& triangles() const { return out_; }
    /// Gives own vertices of the surface at which pieces were looked at the normals of their pieces: where several tie,
    /// another's derivative may have been found before. `normals` begins with them.
    void takeNormalsOfPieces(PageVector<Vec3f>& normals) const;
    /// Vertices inside faces on the block's sides, by axis: as own vertices on high sides, and how many are ghosts
    /// on low sides. Both blocks at a side list them in the same order.
    const std::vector<uint32_t>& shared(int axis) const { return border_.shared[static_cast<size_t>(axis)]; }
    uint32_t ghosts(int axis) const { return border_.ghostCount[static_cast<size_t>(axis)]; }

private:
    struct MixedCell {
        uint32_t cell, firstTriangle, endTriangle;
        int joined = 0;  ///< see loopsOf
    };
    void findMixedCells();
    uint64_t joinFaces(eval::Workspace& workspace);
    const CellLoops& loopsOfCell(const MixedCell& mixed);
    uint32_t vertexAt(Vec3i low, int edge) const;
    void findSegments();
    uint64_t evaluateEnds(eval::Workspace& workspace);
    const PiecePoint& pointAt(uint32_t place);
    int32_t segmentOf(const SurfaceCell& cell, const CellLoop& loop, int side);
    void numberBreaks();
    void splitCells();
    void addNodes(const SurfaceCell& cell, const CellLoop& loop, size_t& side);
    void assemble(const std::vector<uint32_t>& ends);
    void copyTriangles(size_t first, size_t end);

    static constexpr size_t edgePlaces = size_t{3} * cornersPerBlock;

    const BlockSurface* surface_ = nullptr;
    Vec3i first_;  ///< the block's first cell in the grid
    std::vector<MixedCell> mixed_;
    /// Segments of loops in the faces of cells.
    struct Segments {
        std::vector<FaceSegment> list;
        std::vector<std::array<uint32_t, 2>> ends;  ///< places of their vertices
        std::vector<uint8_t> codes;                 ///< their order in a face
        std::vector<uint32_t> breakVertex;
    };
    Segments segments_;
    /// Points of vertices of mixed cells.
    struct Points {
        std::vector<uint32_t> of;  ///< by place: 1 + number of the point there
        std::vector<PiecePoint> list;
    };
    Points points_;
    PieceSamples samples_;
    /// Loops of mixed cells.
    struct Loops {
        std::vector<int32_t> sides;  ///< by side: 2 · segment + reversed, or −1
        CellLoops joined;
    };
    Loops loops_;
    /// By face and code, 1 + segment; before that, 1 + number of an ambiguous face.
    PageVector<uint32_t> segmentAt_ = PageVector<uint32_t>(4 * edgePlaces, 0u);
    FaceCreases creases_;
    CellPieces pieces_;
    std::vector<LoopNode> nodes_;
    PieceTriangles split_, out_;
    std::vector<uint32_t> cellEnds_;
    /// Vertices on the block's sides, by axis.
    struct Sides {
        std::array<std::vector<uint32_t>, 3> shared;
        std::array<uint32_t, 3> ghostCount{};
    };
    Sides border_;
};

}  // namespace sgm::mesh
