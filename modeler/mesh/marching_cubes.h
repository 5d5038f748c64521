// The 256 cases of marching cubes, made from a rule instead of typed in.
// Enters: which corners of a cell are inside. Leaves: triangles over the cell's edges. Assumes nothing about the field.
// Lorensen & Cline 1987 (SG-M III-G), with a rule of our own where theirs leaves holes:
//
//   Walk each face of the cell counter-clockwise, seen from outside the cell. Every run of inside corners is cut off by
//   one segment, from the edge where the walk enters the run to the edge where it leaves. (On an ambiguous face the two
//   inside corners are thus apart.) The segments join into loops. A loop is split into triangles by the chords of least
//   total squared length between edge midpoints, none of which lies in a face of the cell; ties go to the lower edge.
//
// Two cells read the same segments from the face they share, and touch it nowhere else: so the surface is closed,
// oriented and 2-manifold. Triangles of one cell never cross, wherever the vertices lie inside their edges: the
// shortest chords see to it (of the 16 triangulations of a loop of seven, 4 can cross themselves), and a test proves it
// over positions.
#pragma once

#include <array>
#include <cstdint>

namespace sgm::mesh {

/// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4 from `edgeCorner(e)` upwards.
inline constexpr int edgesPerCell = 12;
constexpr int edgeAxis(int e) { return e / 4; }
/// The low corner of edge e: bits 0 and 1 of e are the offsets along the other two axes, in ascending order.
constexpr int edgeCorner(int e) {
    const int a = e & 1, b = e >> 1 & 1;
    switch (edgeAxis(e)) {
        case 0:
            return a << 1 | b << 2;
        case 1:
            return a | b << 2;
        default:
            return a | b << 1;
    }
}

/// The triangles of one case: three edges each, counter-clockwise seen from outside the solid.
struct CellCase {
    uint8_t triangles = 0;
    std::array<uint8_t, 15> edges{};
};

/// All cases, by the bit mask of inside corners.
using CaseTable = std::array<CellCase, 256>;
const CaseTable& caseTable();

/// A closed polygon of one case: edges counter-clockwise seen from outside the solid, and the cell's faces that hold
/// the sides: side i runs from edges[i] to the next edge in face 2 · axis + (0 low, 1 high).
struct CellLoop {
    uint8_t size = 0;
    std::array<uint8_t, edgesPerCell> edges{}, faces{};
};

/// The polygons of one case, in the order in which `CellCase` lists their triangles.
struct CellLoops {
    uint8_t count = 0;
    std::array<CellLoop, 4> loops{};
};

/// All cases, by the bit mask of inside corners.
using LoopTable = std::array<CellLoops, 256>;
const LoopTable& loopTable();

/// The polygons of a case where on some faces, bit 2 · axis + side of `joined`, the inside corners are joined instead
/// of apart; only faces whose corners alternate make a difference.
CellLoops loopsOf(int inside, int joined);

}  // namespace sgm::mesh
