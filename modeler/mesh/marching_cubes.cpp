#include "modeler/mesh/marching_cubes.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace sgm::mesh {
namespace {

/// Corners of the face at `side` (0 low, 1 high) of `axis`, counter-clockwise seen from outside the cell.
std::array<int, 4> faceCorners(int axis, int side) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
    if (side) return {base, base | u, base | u | v, base | v};
    return {base, base | v, base | u | v, base | u};
}

int edgeBetween(int corner0, int corner1) {
    const int low = corner0 & corner1, bit = corner0 ^ corner1;
    for (int e = 0; e < edgesPerCell; ++e)
        if (edgeCorner(e) == low && 1 << edgeAxis(e) == bit) return e;
    assert(false && "corners of one edge");
    return -1;
}

/// By edge the next one of its loop, −1 where the surface doesn't cross it, and the face between them.
struct Segments {
    std::array<int, edgesPerCell> next, face;
};

Segments traceSegments(int inside, int joined) {
    Segments segments;
    segments.next.fill(-1);
    segments.face.fill(-1);
    const auto isIn = [&](int corner) { return (inside >> corner & 1) != 0; };
    for (int face = 0; face < 6; ++face) {
        const std::array<int, 4> corners = faceCorners(face / 2, face % 2);
        const bool join = (joined >> face & 1) != 0 && isIn(corners[0]) == isIn(corners[2]) &&
                          isIn(corners[1]) == isIn(corners[3]) && isIn(corners[0]) != isIn(corners[1]);
        for (int i = 0; i < 4; ++i) {
            const int before = corners[(i + 3) % 4];
            if (isIn(before) || !isIn(corners[i])) continue;
            int last = i;
            while (isIn(corners[(last + 1) % 4])) last = (last + 1) % 4;
            const int from = edgeBetween(before, corners[i]);
            // Joined, the segment cuts off the outside corner before the run instead.
            segments.next[from] = join ? edgeBetween(corners[(i + 2) % 4], corners[(i + 3) % 4])
                                       : edgeBetween(corners[last], corners[(last + 1) % 4]);
            segments.face[from] = face;
        }
    }
    return segments;
}

/// Midpoint of an edge, in half cells.
std::array<int, 3> midpoint(int e) {
    std::array<int, 3> m{};
    for (int axis = 0; axis < 3; ++axis) m[axis] = axis == edgeAxis(e) ? 1 : 2 * (edgeCorner(e) >> axis & 1);
    return m;
}

constexpr int noChord = 1 << 20;

/// Squared length of the chord between two edges' midpoints in half cells, `noChord` when it lies in a face.
int chordCost(int e0, int e1) {
    const auto a = midpoint(e0), b = midpoint(e1);
    int cost = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (a[axis] == b[axis] && a[axis] != 1) return noChord;
        cost += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    }
    return cost;
}

/// Minimum-weight triangulation of a loop of edges by dynamic programming over sub-chains [i, j].
class LoopTriangulation {
public:
    LoopTriangulation(const std::array<int, edgesPerCell>& loop, int size) : loop_(loop) {
        for (int span = 2; span < size; ++span)
            for (int i = 0; i + span < size; ++i) {
                const int j = i + span;
                cost_[i][j] = std::numeric_limits<int>::max();
                for (int k = i + 1; k < j; ++k) {
                    const int cost = cost_[i][k] + cost_[k][j] + chord(i, k) + chord(k, j);
                    if (cost < cost_[i][j]) cost_[i][j] = cost, apex_[i][j] = k;
                }
            }
        assert(cost_[0][size - 1] < noChord);
    }
    void emit(int i, int j, CellCase& out) const {
        if (j - i < 2) return;
        const int k = apex_[i][j];
        emit(i, k, out);
        emit(k, j, out);
        for (const int corner : {i, k, j})
            out.edges[3 * out.triangles + (corner == i   ? 0
                                           : corner == k ? 1
                                                         : 2)] = static_cast<uint8_t>(loop_[corner]);
        ++out.triangles;
    }

private:
    int chord(int i, int j) const { return j - i == 1 ? 0 : chordCost(loop_[i], loop_[j]); }

    std::array<int, edgesPerCell> loop_;
    int cost_[edgesPerCell][edgesPerCell]{};
    int apex_[edgesPerCell][edgesPerCell]{};
};

CellLoops traceLoops(int inside, int joined) {
    CellLoops result;
    Segments segments = traceSegments(inside, joined);
    for (int start = 0; start < edgesPerCell; ++start) {
        if (segments.next[start] < 0) continue;
        CellLoop& loop = result.loops[result.count++];
        for (int e = start; segments.next[e] >= 0;) {
            loop.edges[loop.size] = static_cast<uint8_t>(e);
            loop.faces[loop.size++] = static_cast<uint8_t>(segments.face[e]);
            const int following = segments.next[e];
            segments.next[e] = -1;
            e = following;
        }
    }
    return result;
}

CellCase makeCase(const CellLoops& loops) {
    CellCase result;
    for (int l = 0; l < loops.count; ++l) {
        std::array<int, edgesPerCell> edges{};
        std::copy_n(loops.loops[l].edges.begin(), loops.loops[l].size, edges.begin());
        LoopTriangulation(edges, loops.loops[l].size).emit(0, loops.loops[l].size - 1, result);
    }
    return result;
}

LoopTable makeLoops() {
    LoopTable table;
    for (int inside = 0; inside < 256; ++inside) table[inside] = traceLoops(inside, 0);
    return table;
}

CaseTable makeTable() {
    CaseTable table;
    for (int inside = 0; inside < 256; ++inside) table[inside] = makeCase(loopTable()[inside]);
    return table;
}

}  // namespace

CellLoops loopsOf(int inside, int joined) { return traceLoops(inside, joined); }

const LoopTable& loopTable() {
    static const LoopTable table = makeLoops();
    return table;
}

const CaseTable& caseTable() {
    static const CaseTable table = makeTable();
    return table;
}

}  // namespace sgm::mesh
