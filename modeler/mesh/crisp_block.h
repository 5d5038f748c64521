// A block's surface with its creases: cells in which all is one smooth piece keep the triangles of marching cubes, the
// others are split along creases and borders.
// Enters: the vertices of marching cubes with their labels. Leaves: triangles, new vertices, and which of them blocks
// share. Assumes labels and places that blocks around an edge agree on, bit by bit.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/mesh/block_surface.h"
#include "modeler/mesh/cell_pieces.h"
#include "modeler/mesh/straight_runs.h"

namespace sgm::mesh {

/// One worker's, reused from block to block.
class CrispBlock {
public:
    /// `mergesCells`: see PolygonizeOptions.
    explicit CrispBlock(bool mergesCells) : runs_(mergesCells ? std::make_unique<StraightRuns>() : nullptr) {}
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
    void findMixedCells();
    uint64_t joinFaces(eval::Workspace& workspace);
    const CellLoops& loopsOfCell(const MixedCell& mixed);
    uint32_t placeAt(Vec3i low, int edge) const;
    void findSegments();
    void findSegmentsOfRuns();
    void forgetPlaces();
    uint64_t findBreaks(eval::Workspace& workspace);
    bool leaveOutBent();
    RunEnd endOf(size_t run, size_t end) const;
    uint64_t evaluateEnds(size_t first, eval::Workspace& workspace);
    const PiecePoint& pointAt(uint32_t place);
    int32_t segmentOf(const SurfaceCell& cell, const CellLoop& loop, int side);
    void numberBreaks();
    void splitCells();
    void addNodes(const SurfaceCell& cell, const CellLoop& loop, size_t& side);
    void assemble();
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
        std::vector<std::array<uint32_t, 2>> ofRuns;  ///< at their ends
    };
    Segments segments_;
    /// Points of vertices of mixed cells.
    struct Points {
        std::vector<uint32_t> of;  ///< by place: 1 + number of the point there
        std::vector<PiecePoint> list;
        std::vector<float> values;  ///< of the field there, of those that end segments

        void clear(size_t places) {
            list.clear(), values.clear();
            list.reserve(places);  // so that nodes may point there
            of.assign(places, 0);
        }
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
    /// What mixed cells are split into, those in no run.
    struct Split {
        PieceTriangles pieces;
        std::vector<uint32_t> cellEnds;
    };
    Split split_;
    std::unique_ptr<StraightRuns> runs_;  ///< null where cells stay as they are
    PieceTriangles out_;
    /// Vertices on the block's sides, by axis.
    struct Sides {
        std::array<std::vector<uint32_t>, 3> shared;
        std::array<uint32_t, 3> ghostCount{};
    };
    Sides border_;
};

}  // namespace sgm::mesh
