// The surface in a cell, split into its smooth pieces: a polygon a piece, along creases between breaks on the cell's
// faces, which meet in a corner where there are three or more.
// Enters: closed loops of vertices and breaks around cells. Leaves: triangles with labels, new vertices at corners.
// Assumes breaks that neighbouring cells read from the face they share: so the surface is closed, whatever is done
// inside a cell. Polygons that fold over are replaced by triangles around a point inside the cell, which never cross;
// those of several loops are placed so that they don't either, as far as places are found.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/mesh/border_corners.h"
#include "modeler/mesh/face_creases.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/small_polygon.h"

namespace sgm::mesh {

/// A vertex of a loop and the piece of the side that follows it.
struct LoopNode {
    uint32_t vertex;  ///< its corner number in the chunk
    Vec3f at;
    uint32_t label;
    OriginId origin;
    bool isBreak = false;  ///< the piece before it is another one
    int8_t face = -1;      ///< of a break, the face of the cell that it lies on
    /// Of a break, before and after it; of a vertex, itself. They have to stay until all is triangulated.
    std::array<const PiecePoint*, 2> sides{};
    const Vec3f* crossing = nullptr;  ///< of a break, see Break
};

/// The side of a break that has a label, else the nearer guess.
inline const PiecePoint& sideOf(const LoopNode& node, uint32_t label) {
    return *node.sides[node.sides[1]->label == label ? 1 : 0];
}

/// What the pieces of a block's cells are written to.
struct PieceTriangles {
    std::vector<Triangle> triangles;
    std::vector<uint32_t> labels;
    std::vector<OriginId> origins;
    std::vector<CornerNormal> cornerNormals;  ///< corners count in `triangles`
    std::vector<Vec3f> positions, normals;    ///< of new vertices
    std::vector<ConfinedVertex> confined;     ///< of new vertices
    void clear() {
        triangles.clear(), labels.clear(), origins.clear(), cornerNormals.clear();
        positions.clear(), normals.clear(), confined.clear();
    }
};

/// The point inside a cell, a little off its sides, that is nearest to `p`, metres.
Vec3f inCell(const Grid& grid, Vec3i cell, Vec3f p);

/// One worker's splitter, reused from block to block.
class CellPieces {
public:
    /// Begins a block.
    void clear();
    /// Adds a loop of `cell`, which lies in `brick`, counter-clockwise seen from outside the solid.
    void addLoop(Vec3i cell, size_t brick, std::span<const LoopNode> nodes);
    /// Ends a group of loops: their triangles are one after the other.
    void endCell() { cellEnds_.push_back(static_cast<uint32_t>(loops_.size())); }
    /// Places corners, numbered from `firstVertex` on. Returns how often the field was evaluated.
    uint64_t placeCorners(const BlockTapes& tapes, const Grid& grid, eval::Workspace& workspace, uint32_t firstVertex);
    /// Triangulates everything. `cellEnds[i]` is the end of the triangles of the i-th cell.
    void triangulate(PieceTriangles& out, std::vector<uint32_t>& cellEnds);

private:
    /// Nodes [first, end) of one piece.
    struct Polygon {
        uint32_t first, end;
        uint32_t label;
        OriginId origin;
    };
    struct Loop {
        Vec3i cell;
        size_t brick;
        uint32_t firstNode, endNode;        ///< as they came
        uint32_t firstPolygon, endPolygon;  ///< in order
        int32_t corner;                     ///< −1 for none
    };
    using Corner = CellCorner;

    struct Corners {
        std::vector<Corner> list, spare;

        void clear();
        /// One more, whose lists are empty and have the memory of one before.
        Corner& add();
    };

    /// A parallelogram in a plane in which a corner between borders is looked for.
    struct FlatCorner {
        Corner* corner;
        Vec3f low, alongU, alongV;
        Vec3f place(float u, float v) const { return low + alongU * u + alongV * v; }
    };

    void addPolygon(std::span<const LoopNode> nodes);
    void addSplit(Loop& loop, std::vector<LoopNode>& nodes);
    void addCorner(Loop& loop, const std::vector<LoopNode>& nodes);
    uint64_t confirmMeetings(const BlockTapes& tapes, eval::Workspace& workspace);
    void findSmoothCorners();
    uint64_t moveToSurface(const BlockTapes& tapes, eval::Workspace& workspace);
    bool meets(const Corner& corner) const;
    uint64_t searchFlatCorners(const BlockTapes& tapes, eval::Workspace& workspace);
    FlatCorner squareAround(Corner& corner) const;
    bool narrow(FlatCorner& flat, size_t sample) const;
    uint64_t lookAtPlanes(const BlockTapes& tapes, eval::Workspace& workspace);
    void intersect(Corner& corner) const;
    void writeCorners();
    bool liesInFace(Vec3f a, Vec3f b) const;
    bool triangulatePolygon(const Polygon& polygon, PieceTriangles& out);
    bool triangulateLoop(const Loop& loop, PieceTriangles& out);
    bool crosses(const PieceTriangles& out, size_t firstTriangle) const;
    bool isPartedByCrease(const Loop& loop) const;
    Vec3f middleOf(uint32_t firstLoop, uint32_t endLoop) const;
    void fan(uint32_t loop, Vec3f middle, PieceTriangles& out);
    void dropTriangles(size_t triangles, PieceTriangles& out);
    bool fanApart(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out);
    bool searchMiddles(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out, int& tries);
    void fanLoops(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out);
    void emit(const LoopNode& a, const LoopNode& b, const LoopNode& c, const Polygon& piece, Vec3f normal,
              PieceTriangles& out);

    const Grid* grid_ = nullptr;
    std::vector<LoopNode> nodes_, scratch_, rest_;
    std::vector<size_t> breaks_;  ///< in rest_
    SmallPolygon shape_;          ///< of the polygon in work
    std::vector<Polygon> polygons_;
    std::vector<Loop> loops_;
    Corners corners_;
    BorderCorners borderCorners_;
    PieceSamples probes_;  ///< near corners
    std::vector<uint32_t> cellEnds_;
    uint32_t firstVertex_ = 0;
    /// The cell in work.
    struct CellInWork {
        Vec3f low, high;
        std::vector<std::array<Vec3f, 3>> places;  ///< of its triangles
        std::vector<Vec3d> normals;                ///< of its polygons
    };
    CellInWork cell_;
};

}  // namespace sgm::mesh
