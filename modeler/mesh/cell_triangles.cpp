// The pieces of cells as triangles.
#include <algorithm>

#include "modeler/mesh/cell_pieces.h"
#include "modeler/mesh/crossing.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t mostSmall = 6;       ///< nodes of a polygon whose ears lie beside each other
constexpr int mostTries = 1024;         ///< places for the middles of fans in one cell
constexpr double flatNormals = 0.9999;  ///< length of the mean of a flat piece's normals
constexpr double leastSquare = 1e-16;   ///< of the sine between a plane and the way to a point beside it

double square(Vec3d v) { return dot(v, v); }

/// Whether a loop has two pieces along one crease, and the point amid that.
bool isOneCrease(std::span<const LoopNode> nodes, Vec3f& middle) {
    int breaks = 0;
    Vec3f sum{};
    for (const LoopNode& node : nodes)
        if (node.isBreak) ++breaks, sum += *node.crossing;
    middle = sum * 0.5f;
    return breaks == 2;
}

}  // namespace

void CellPieces::emit(const LoopNode& a, const LoopNode& b, const LoopNode& c, const Polygon& piece, Vec3f normal,
                      PieceTriangles& out) {
    const auto triangle = static_cast<uint32_t>(out.triangles.size());
    const LoopNode* const corners[] = {&a, &b, &c};
    for (uint32_t k = 0; k < 3; ++k) {
        const LoopNode& node = *corners[k];
        const bool isEdgeVertex = node.sides[0]->label == piece.label && node.sides[1]->label == piece.label &&
                                  !node.isBreak && (node.vertex < firstVertex_ || (node.vertex & ghostBit) != 0);
        if (isEdgeVertex) continue;
        const PiecePoint& side = sideOf(node, piece.label);
        Vec3f n = side.label == piece.label ? normalized(side.gradient) : normal;
        // Where faces of two parts coincide, as a pier's foot and a slab, the gradient may be the other's.
        if (dot(n, normal) < -0.5f) n = normal;
        out.cornerNormals.push_back({3 * triangle + k, n == Vec3f{} ? normal : n});
    }
    out.triangles.push_back({a.vertex, b.vertex, c.vertex});
    cell_.places.push_back({a.at, b.at, c.at});
    out.labels.push_back(piece.label);
    out.origins.push_back(piece.origin);
}

/// Whether a diagonal lies in a face of the cell in work: it might be the neighbour's too.
bool CellPieces::liesInFace(Vec3f a, Vec3f b) const {
    for (int axis = 0; axis < 3; ++axis)
        if (a[axis] == b[axis] && (a[axis] == cell_.low[axis] || a[axis] == cell_.high[axis])) return true;
    return false;
}

/// False where no triangulation faces outward.
bool CellPieces::triangulatePolygon(const Polygon& polygon, PieceTriangles& out) {
    Vec3d expected{};
    double count = 0;  // of normals
    shape_.clear();
    for (uint32_t i = polygon.first; i < polygon.end; ++i) {
        shape_.add(nodes_[i].at.as<double>());
        if (const PiecePoint& side = sideOf(nodes_[i], polygon.label); side.label == polygon.label)
            expected += normalized(side.gradient.as<double>()), ++count;
    }
    const Vec3d sum = shape_.doubleArea();
    if (!(dot(sum, expected) > 0)) return false;
    const Vec3d n = normalized(sum);
    cell_.normals.push_back(n);
    const auto node = [&](size_t i) -> const LoopNode& { return nodes_[polygon.first + i]; };
    // Where a corner of a flat piece is off its plane, the best ears leave most of the piece in it.
    const bool isCurved = length(expected) < flatNormals * count;
    const auto mayJoin = [&](size_t i, size_t k) { return !liesInFace(node(i).at, node(k).at); };
    if (!shape_.triangulate(n, isCurved, mayJoin)) return false;
    for (const auto& [a, b, c] : shape_.triangles()) emit(node(a), node(b), node(c), polygon, n.as<float>(), out);
    return true;
}

bool CellPieces::triangulateLoop(const Loop& loop, PieceTriangles& out) {
    for (uint32_t p = loop.firstPolygon; p < loop.endPolygon; ++p)
        if (!triangulatePolygon(polygons_[p], out)) return false;
    return true;
}

/// Whether two small polygons lie on either side of the plane along the crease between them, and amid their own: so
/// their triangles don't cross.
bool CellPieces::isPartedByCrease(const Loop& loop) const {
    if (loop.endPolygon - loop.firstPolygon != 2) return false;
    const Polygon &a = polygons_[loop.firstPolygon], &b = polygons_[loop.firstPolygon + 1];
    if (std::max(a.end - a.first, b.end - b.first) > mostSmall) return false;
    // The first one was cut off between its ends.
    const LoopNode &begin = nodes_[a.first], &end = nodes_[a.end - 1];
    const Vec3d from = begin.at.as<double>();
    const Vec3d across = cross(end.at.as<double>() - from, cell_.normals[0] + cell_.normals[1]);
    const auto liesBeside = [&](const Polygon& polygon, Vec3d direction) {
        for (uint32_t i = polygon.first; i < polygon.end; ++i) {
            if (nodes_[i].vertex == begin.vertex || nodes_[i].vertex == end.vertex) continue;
            const Vec3d way = nodes_[i].at.as<double>() - from;
            const double beyond = dot(direction, way);
            if (!(beyond > 0 && beyond * beyond > leastSquare * square(direction) * square(way))) return false;
        }
        return true;
    };
    return (liesBeside(a, across) && liesBeside(b, -across)) || (liesBeside(a, -across) && liesBeside(b, across));
}

bool CellPieces::crosses(const PieceTriangles& out, size_t firstTriangle) const {
    return anyCross(cell_.places, std::span(out.triangles).subspan(firstTriangle));
}

/// The middle of all nodes of some loops.
Vec3f CellPieces::middleOf(uint32_t firstLoop, uint32_t endLoop) const {
    Vec3f sum{};
    uint32_t count = 0;
    for (uint32_t l = firstLoop; l < endLoop; ++l)
        for (uint32_t i = loops_[l].firstNode; i < loops_[l].endNode; ++i, ++count) sum += nodes_[i].at;
    return sum * (1.0f / static_cast<float>(count));
}

/// Triangles from a point in the cell, the nearest one to `place`, to all sides of the loop; they never cross each
/// other.
void CellPieces::fan(uint32_t l, Vec3f place, PieceTriangles& out) {
    Loop& loop = loops_[l];
    const auto nodes = std::span(nodes_).subspan(loop.firstNode, loop.endNode - loop.firstNode);
    static constexpr PiecePoint noPiece{};
    LoopNode middle{};
    middle.sides = {&noPiece, &noPiece};
    middle.isBreak = true;
    middle.at = inCell(*grid_, loop.cell, place);
    if (loop.corner < 0) {
        loop.corner = static_cast<int32_t>(corners_.list.size());
        corners_.add();
    }
    middle.vertex = firstVertex_ + static_cast<uint32_t>(loop.corner);
    Corner& corner = corners_.list[static_cast<size_t>(loop.corner)];
    if (corner.planes.empty())
        corner.leaves = isOneCrease(nodes, corner.meeting);
    else
        corner.leaves = corner.leaves || corner.meeting == corner.at;
    corner.at = middle.at;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const LoopNode &a = nodes[i], &b = nodes[(i + 1) % nodes.size()];
        const Polygon piece{0, 0, a.label, a.origin};
        const PiecePoint& side = sideOf(a, a.label);
        const Vec3f own = side.label == a.label ? normalized(side.gradient) : Vec3f{};
        const Vec3d across =
            cross(a.at.as<double>() - middle.at.as<double>(), b.at.as<double>() - middle.at.as<double>());
        emit(middle, a, b, piece, own == Vec3f{} ? normalized(across).as<float>() : own, out);
    }
}

/// Takes the cell's last triangles away: `triangles` of all are kept.
void CellPieces::dropTriangles(size_t triangles, PieceTriangles& out) {
    cell_.places.resize(cell_.places.size() - (out.triangles.size() - triangles));
    out.triangles.resize(triangles), out.labels.resize(triangles), out.origins.resize(triangles);
    while (!out.cornerNormals.empty() && out.cornerNormals.back().corner >= 3 * triangles) out.cornerNormals.pop_back();
}

/// Fans of the cell's loops, whose middles are moved away from each other until the fans don't cross. False, and no
/// triangles, where that doesn't help.
bool CellPieces::fanApart(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out) {
    const size_t first = out.triangles.size();
    const Vec3f middleOfAll = middleOf(firstLoop, endLoop);
    for (const float apart : {0.0f, 0.5f, 1.0f, 2.0f, 4.0f}) {
        for (uint32_t l = firstLoop; l < endLoop; ++l) {
            const Vec3f middle = middleOf(l, l + 1);
            fan(l, middle + (middle - middleOfAll) * apart, out);
        }
        if (endLoop - firstLoop == 1 || !crosses(out, first)) return true;
        dropTriangles(first, out);
    }
    return false;
}

/// Fans of the loops whose middles are tried all over the cell: near its corners, edges and faces, where surfaces that
/// leave little room between each other have most of it. False, and no triangles of these loops, where none fit.
/// After `tries` places it gives up.
bool CellPieces::searchMiddles(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out, int& tries) {
    if (firstLoop == endLoop) return true;
    const size_t firstOfCell = out.triangles.size() - cell_.places.size(), first = out.triangles.size();
    const Vec3f middle = (cell_.low + cell_.high) * 0.5f, half = (cell_.high - cell_.low) * 0.5f;
    for (const float share : {0.5f, 0.875f, 1.0f})
        for (int place = 0; place < 27 && tries > 0; ++place, --tries) {
            const Vec3f direction{static_cast<float>(place % 3 - 1), static_cast<float>(place / 3 % 3 - 1),
                                  static_cast<float>(place / 9 - 1)};
            fan(firstLoop, middle + half * direction * share, out);
            if (!crosses(out, firstOfCell) && searchMiddles(firstLoop + 1, endLoop, out, tries)) return true;
            dropTriangles(first, out);
        }
    return false;
}

/// Fans of all loops of a cell; they cross only where no middles were found.
void CellPieces::fanLoops(uint32_t firstLoop, uint32_t endLoop, PieceTriangles& out) {
    int tries = mostTries;
    if (fanApart(firstLoop, endLoop, out) || searchMiddles(firstLoop, endLoop, out, tries)) return;
    for (uint32_t l = firstLoop; l < endLoop; ++l) fan(l, middleOf(l, l + 1), out);
}

void CellPieces::triangulate(PieceTriangles& out, std::vector<uint32_t>& cellEnds) {
    cellEnds.clear();
    uint32_t next = 0;
    for (const uint32_t end : cellEnds_) {
        const size_t triangles = out.triangles.size();
        const Vec3i cell = loops_[next].cell;
        cell_.low = grid_->corner(cell.x, cell.y, cell.z),
        cell_.high = grid_->corner(cell.x + 1, cell.y + 1, cell.z + 1);
        cell_.places.clear(), cell_.normals.clear();
        bool good = true;
        for (uint32_t l = next; l < end && good; ++l) good = triangulateLoop(loops_[l], out);
        const bool parted = good && end - next == 1 && isPartedByCrease(loops_[next]);
        if (!good || (!parted && crosses(out, triangles))) {
            dropTriangles(triangles, out);
            fanLoops(next, end, out);
        }
        next = end;
        cellEnds.push_back(static_cast<uint32_t>(out.triangles.size()));
    }
    for (const Corner& corner : corners_.list) {
        Vec3f n{};
        for (const PiecePoint& plane : corner.planes) n += normalized(plane.gradient);
        if (corner.leaves)
            out.confined.push_back(
                {firstVertex_ + static_cast<uint32_t>(&corner - corners_.list.data()), corner.meeting});
        out.positions.push_back(corner.at);
        out.normals.push_back(n == Vec3f{} ? Vec3f{0, 1, 0} : normalized(n));
    }
}

}  // namespace sgm::mesh
