#include "modeler/mesh/cell_pieces.h"

#include <algorithm>
#include <cmath>

#include "modeler/mesh/crossing.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t cornerVertex = 0xffffffffu;  ///< stands for a loop's corner until that is placed
constexpr float probeShare = 0.0625f;
constexpr int cornerRounds = 3;
constexpr float leavingReach = 2;        ///< of a cell, that a corner may lie outside its cell
constexpr float confirmShare = 0x1p-8f;  ///< of a cell times the slope: the field at a confirmed corner
constexpr double towardsMiddle = 1e-6;   ///< weight of the nodes' middle where planes leave a corner open

/// x of A x = b by Cramer's rule, for a symmetric positive definite A.
Vec3d solved(const std::array<Vec3d, 3>& rows, Vec3d b) {
    const double det = dot(rows[0], cross(rows[1], rows[2]));
    if (!(std::abs(det) > 0)) return {};
    return (cross(rows[1], rows[2]) * b.x + cross(rows[2], rows[0]) * b.y + cross(rows[0], rows[1]) * b.z) / det;
}

/// The side of a break that has a label, else the nearer guess.
const PiecePoint& sideOf(const LoopNode& node, uint32_t label) {
    return node.sides[node.sides[1].label == label ? 1 : 0];
}

Vec3d newell(std::span<const LoopNode> nodes) {
    Vec3d sum{};
    const Vec3d first = nodes[0].at.as<double>();
    for (size_t i = 1; i + 1 < nodes.size(); ++i)
        sum += cross(nodes[i].at.as<double>() - first, nodes[i + 1].at.as<double>() - first);
    return sum;
}

/// Twice the area of a triangle as far as it faces along unit `n`.
double facing(const LoopNode& a, const LoopNode& b, const LoopNode& c, Vec3d n) {
    const Vec3d p = a.at.as<double>();
    return dot(cross(b.at.as<double>() - p, c.at.as<double>() - p), n);
}

bool holds(const LoopNode& a, const LoopNode& b, const LoopNode& c, const LoopNode& p, Vec3d n) {
    return facing(a, b, p, n) >= 0 && facing(b, c, p, n) >= 0 && facing(c, a, p, n) >= 0;
}

double squares(const LoopNode& a, const LoopNode& b) {
    const Vec3d d = (b.at - a.at).as<double>();
    return dot(d, d);
}

}  // namespace

void CellPieces::clear() { nodes_.clear(), polygons_.clear(), loops_.clear(), corners_.clear(), cellEnds_.clear(); }

void CellPieces::addPolygon(std::span<const LoopNode> nodes) {
    if (nodes.size() < 3) return;  // a piece that only touches the cell's face
    const auto first = static_cast<uint32_t>(nodes_.size());
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    polygons_.push_back({first, static_cast<uint32_t>(nodes_.size()), nodes[0].label, nodes[0].origin});
}

void CellPieces::addLoop(Vec3i cell, std::span<const LoopNode> nodes) {
    Loop loop{cell, static_cast<uint32_t>(nodes_.size()), 0, 0, 0, -1};
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    loop.endNode = static_cast<uint32_t>(nodes_.size());
    loop.firstPolygon = static_cast<uint32_t>(polygons_.size());
    rest_.assign(nodes.begin(), nodes.end());
    addSplit(loop, rest_);
    loop.endPolygon = static_cast<uint32_t>(polygons_.size());
    loops_.push_back(loop);
}

/// Cuts pieces off by a crease where the pieces before and after them are one; what is left has one piece, two along a
/// crease, or more around a corner. The shortest crease goes first.
void CellPieces::addSplit(Loop& loop, std::vector<LoopNode>& nodes) {
    std::vector<size_t> breaks;
    for (;;) {
        breaks.clear();
        for (size_t i = 0; i < nodes.size(); ++i)
            if (nodes[i].isBreak) breaks.push_back(i);
        const size_t m = breaks.size();
        if (m < 2) break;
        size_t best = m;
        double least = 0;
        for (size_t k = 0; k < m; ++k) {
            const LoopNode &from = nodes[breaks[k]], &to = nodes[breaks[(k + 1) % m]];
            const LoopNode& before = nodes[breaks[(k + m - 1) % m]];
            if (before.label != to.label) continue;
            // A crease in a face of the cell would be the neighbour's too.
            const size_t steps = (breaks[(k + 1) % m] + nodes.size() - breaks[k]) % nodes.size();
            if (from.face == to.face && steps > 1 && steps + 1 < nodes.size()) continue;
            const double length = squares(from, to);
            if (best == m || length < least) best = k, least = length;
        }
        if (best == m) return addCorner(loop, nodes);
        // Turn the loop so that the piece comes first.
        std::rotate(nodes.begin(), nodes.begin() + static_cast<ptrdiff_t>(breaks[best]), nodes.end());
        const size_t end = (breaks[(best + 1) % m] + nodes.size() - breaks[best]) % nodes.size();
        addPolygon(std::span(nodes).first(end + 1));
        const LoopNode& around = nodes[end];
        nodes[0].label = around.label, nodes[0].origin = around.origin;
        nodes[0].isBreak = nodes[end].isBreak = false;
        nodes.erase(nodes.begin() + 1, nodes.begin() + static_cast<ptrdiff_t>(end));
    }
    addPolygon(nodes);
}

void CellPieces::addCorner(Loop& loop, const std::vector<LoopNode>& nodes) {
    loop.corner = static_cast<int32_t>(corners_.size());
    Corner& corner = corners_.emplace_back();
    corner.cell = loop.cell;
    corner.loop = static_cast<uint32_t>(loops_.size());
    const size_t n = nodes.size();
    const size_t first = static_cast<size_t>(
        std::find_if(nodes.begin(), nodes.end(), [](const LoopNode& p) { return p.isBreak; }) - nodes.begin());
    Vec3f sum{};
    for (size_t i = 0; i < n;) {
        const size_t from = (first + i) % n;
        scratch_.clear();
        Vec3f middle{};
        do {
            scratch_.push_back(nodes[(first + i) % n]);
            middle += scratch_.back().at;
            ++i;
        } while (i < n && !nodes[(first + i) % n].isBreak);
        const LoopNode& end = nodes[(first + i) % n];
        scratch_.push_back(end);
        middle += end.at;
        corner.labels.push_back(nodes[from].label);
        corner.means.push_back(middle * (1.0f / static_cast<float>(scratch_.size())));
        for (const LoopNode* at : {&nodes[from], &end}) {
            corner.planes.push_back(sideOf(*at, nodes[from].label));
            sum += at->at;
        }
        scratch_.push_back(end);
        scratch_.back().vertex = cornerVertex;
        addPolygon(scratch_);
    }
    corner.at = sum * (1.0f / static_cast<float>(corner.planes.size()));
}

/// The nearest point inside a cell.
Vec3f CellPieces::inCell(Vec3i cell, Vec3f p) const {
    const Vec3f low = grid_->corner(cell.x, cell.y, cell.z), high = grid_->corner(cell.x + 1, cell.y + 1, cell.z + 1);
    const Vec3f margin = (high - low) * 0x1.0p-8f;
    return max(low + margin, min(high - margin, p));
}

/// Moves a corner to where its planes meet, by least squares.
void CellPieces::intersect(Corner& corner) const {
    const Vec3d middle = corner.at.as<double>();
    std::array<Vec3d, 3> rows{Vec3d{towardsMiddle, 0, 0}, Vec3d{0, towardsMiddle, 0}, Vec3d{0, 0, towardsMiddle}};
    Vec3d right{};
    for (const PiecePoint& plane : corner.planes) {
        const Vec3d n = normalized(plane.gradient.as<double>());
        const double d = dot(n, plane.at.as<double>() - middle);
        for (int axis = 0; axis < 3; ++axis) rows[static_cast<size_t>(axis)] += n * n[axis];
        right += n * d;
    }
    corner.meeting = (middle + solved(rows, right)).as<float>();
    corner.at = inCell(corner.cell, corner.meeting);
}

/// Evaluates the pieces at some points.
void CellPieces::probe(const eval::Tape& tape, eval::Workspace& workspace, std::span<const Vec3f> points) {
    const size_t n = points.size();
    std::vector<float> x(n), y(n), z(n), rows(4 * n);
    std::vector<uint32_t> labels(n);
    std::vector<OriginId> origins(n);
    for (size_t i = 0; i < n; ++i) x[i] = points[i].x, y[i] = points[i].y, z[i] = points[i].z;
    eval::evaluatePieces(tape, {x.data(), y.data(), z.data(), n},
                         {rows.data(), &rows[n], &rows[2 * n], &rows[3 * n], labels.data(), origins.data()}, workspace);
    probes_.clear();
    for (size_t i = 0; i < n; ++i)
        probes_.push_back(
            {rows[i],
             {points[i], {rows[n + i], rows[2 * n + i], rows[3 * n + i]}, labelOf(labels[i], origins[i]), origins[i]}});
}

/// A meeting outside the cell counts where it lies on the surface, on one of the corner's pieces.
void CellPieces::confirmMeetings(const eval::Tape& tape, eval::Workspace& workspace) {
    std::vector<Vec3f> points;
    for (Corner& corner : corners_) {
        corner.leaves =
            corner.meeting != corner.at && length(corner.meeting - corner.at) <= leavingReach * grid_->cell_m;
        if (corner.leaves) points.push_back(corner.meeting);
    }
    if (points.empty()) return;
    probe(tape, workspace, points);
    size_t i = 0;
    for (Corner& corner : corners_) {
        if (!corner.leaves) continue;
        const Probe& seen = probes_[i++];
        const auto& labels = corner.labels;
        corner.leaves = std::find(labels.begin(), labels.end(), seen.point.label) != labels.end() &&
                        std::abs(seen.value) <= confirmShare * grid_->cell_m * length(seen.point.gradient);
    }
}

uint64_t CellPieces::placeCorners(const eval::Tape& tape, const Grid& grid, eval::Workspace& workspace,
                                  uint32_t firstVertex) {
    grid_ = &grid;
    firstVertex_ = firstVertex;
    for (Corner& corner : corners_) intersect(corner);
    uint64_t evaluations = 0;
    for (int round = 0; round < cornerRounds && !corners_.empty(); ++round) {
        std::vector<Vec3f> points;
        for (const Corner& corner : corners_) {
            const bool isNear = length(corner.meeting - corner.at) <= leavingReach * grid.cell_m;
            const Vec3f from = round > 0 && isNear ? corner.meeting : corner.at;
            for (const Vec3f& mean : corner.means) points.push_back(from + (mean - from) * probeShare);
        }
        probe(tape, workspace, points);
        evaluations += probes_.size();
        size_t i = 0;
        for (Corner& corner : corners_) {
            std::vector<PiecePoint> seen;
            for (size_t k = 0; k < corner.means.size(); ++k, ++i) {
                PiecePoint plane = probes_[i].point;
                const double value = probes_[i].value;
                const Vec3d g = plane.gradient.as<double>();
                const double square = dot(g, g);
                if (plane.label == corner.labels[k] && square > 0 &&
                    std::abs(value) < std::sqrt(square) * grid.cell_m) {
                    plane.at = (plane.at.as<double>() - g * (value / square)).as<float>();
                    seen.push_back(plane);
                } else {
                    for (const PiecePoint& known : corner.planes)
                        if (known.label == corner.labels[k]) seen.push_back(known);
                }
            }
            corner.planes = std::move(seen);
            intersect(corner);
        }
    }
    probes_.clear();
    confirmMeetings(tape, workspace);
    evaluations += probes_.size();
    for (const Loop& loop : loops_) {
        if (loop.corner < 0) continue;
        const Corner& corner = corners_[static_cast<size_t>(loop.corner)];
        for (uint32_t p = loop.firstPolygon; p < loop.endPolygon; ++p)
            for (uint32_t i = polygons_[p].first; i < polygons_[p].end; ++i)
                if (nodes_[i].vertex == cornerVertex) {
                    nodes_[i].vertex = firstVertex + static_cast<uint32_t>(loop.corner);
                    nodes_[i].at = corner.at;
                    nodes_[i].isBreak = true;
                    for (const PiecePoint& plane : corner.planes)
                        if (plane.label == polygons_[p].label) nodes_[i].sides[0] = nodes_[i].sides[1] = plane;
                }
    }
    return evaluations;
}

void CellPieces::emit(const LoopNode& a, const LoopNode& b, const LoopNode& c, const Polygon& piece, Vec3f normal,
                      PieceTriangles& out) {
    const auto triangle = static_cast<uint32_t>(out.triangles.size());
    const LoopNode* const corners[] = {&a, &b, &c};
    for (uint32_t k = 0; k < 3; ++k) {
        const LoopNode& node = *corners[k];
        const bool isEdgeVertex = node.sides[0].label == piece.label && node.sides[1].label == piece.label &&
                                  !node.isBreak && (node.vertex < firstVertex_ || (node.vertex & borrowedBit) != 0);
        if (isEdgeVertex) continue;
        const PiecePoint& side = sideOf(node, piece.label);
        const Vec3f n = side.label == piece.label ? normalized(side.gradient) : normal;
        out.cornerNormals.push_back({3 * triangle + k, n == Vec3f{} ? normal : n});
    }
    out.triangles.push_back({a.vertex, b.vertex, c.vertex});
    places_.push_back({a.at, b.at, c.at});
    out.labels.push_back(piece.label);
    out.origins.push_back(piece.origin);
}

/// Whether a diagonal lies in a face of the cell at hand: it might be the neighbour's too.
bool CellPieces::liesInFace(const LoopNode& a, const LoopNode& b) const {
    for (int axis = 0; axis < 3; ++axis)
        if (a.at[axis] == b.at[axis] && (a.at[axis] == low_[axis] || a.at[axis] == high_[axis])) return true;
    return false;
}

/// Cuts ears off, the best shaped first. False where none is left that faces outward.
bool CellPieces::triangulatePolygon(const Polygon& polygon, PieceTriangles& out) {
    const auto nodes = std::span(nodes_).subspan(polygon.first, polygon.end - polygon.first);
    Vec3d expected{};
    for (const LoopNode& node : nodes)
        if (const PiecePoint& side = sideOf(node, polygon.label); side.label == polygon.label)
            expected += normalized(side.gradient.as<double>());
    const Vec3d sum = newell(nodes), n = normalized(sum);
    if (!(dot(sum, expected) > 0)) return false;
    const Vec3f normal = n.as<float>();
    scratch_.assign(nodes.begin(), nodes.end());
    while (scratch_.size() > 3) {
        const size_t count = scratch_.size();
        size_t best = count;
        double most = 0;
        for (size_t i = 0; i < count; ++i) {
            const LoopNode &a = scratch_[(i + count - 1) % count], &b = scratch_[i], &c = scratch_[(i + 1) % count];
            const double quality = facing(a, b, c, n) / (squares(a, b) + squares(b, c) + squares(c, a));
            if (!(quality > most)) continue;
            bool ear = !liesInFace(a, c);
            for (size_t k = 0; k + 3 < count && ear; ++k) ear = !holds(a, b, c, scratch_[(i + 2 + k) % count], n);
            if (ear) best = i, most = quality;
        }
        if (best == count) return false;
        emit(scratch_[(best + count - 1) % count], scratch_[best], scratch_[(best + 1) % count], polygon, normal, out);
        scratch_.erase(scratch_.begin() + static_cast<ptrdiff_t>(best));
    }
    if (!(facing(scratch_[0], scratch_[1], scratch_[2], n) > 0)) return false;
    emit(scratch_[0], scratch_[1], scratch_[2], polygon, normal, out);
    return true;
}

bool CellPieces::triangulateLoop(const Loop& loop, PieceTriangles& out) {
    for (uint32_t p = loop.firstPolygon; p < loop.endPolygon; ++p)
        if (!triangulatePolygon(polygons_[p], out)) return false;
    return true;
}

bool CellPieces::crosses(const PieceTriangles& out, size_t firstTriangle) const {
    return anyCross(places_, std::span(out.triangles).subspan(firstTriangle));
}

/// The middle of all nodes of some loops.
Vec3f CellPieces::middleOf(uint32_t firstLoop, uint32_t endLoop) const {
    Vec3f sum{};
    uint32_t count = 0;
    for (uint32_t l = firstLoop; l < endLoop; ++l)
        for (uint32_t i = loops_[l].firstNode; i < loops_[l].endNode; ++i, ++count) sum += nodes_[i].at;
    return sum * (1.0f / static_cast<float>(count));
}

/// Whether a loop has two pieces along one crease, and the point amid that.
bool CellPieces::isOneCrease(std::span<const LoopNode> nodes, Vec3f& middle) {
    int breaks = 0;
    Vec3f sum{};
    for (const LoopNode& node : nodes)
        if (node.isBreak) ++breaks, sum += node.crossing;
    middle = sum * 0.5f;
    return breaks == 2;
}

/// Triangles from a point in the cell to all sides of the loop, which never cross each other.
void CellPieces::fan(uint32_t l, Vec3f middleOfAll, float apart, PieceTriangles& out) {
    Loop& loop = loops_[l];
    const auto nodes = std::span(nodes_).subspan(loop.firstNode, loop.endNode - loop.firstNode);
    LoopNode middle{};
    middle.at = middleOf(l, l + 1);
    middle.at = inCell(loop.cell, middle.at + (middle.at - middleOfAll) * apart);
    if (loop.corner < 0) {
        loop.corner = static_cast<int32_t>(corners_.size());
        corners_.emplace_back();
    }
    middle.vertex = firstVertex_ + static_cast<uint32_t>(loop.corner);
    Corner& corner = corners_[static_cast<size_t>(loop.corner)];
    if (corner.planes.empty())
        corner.leaves = isOneCrease(nodes, corner.meeting);
    else
        corner.leaves = corner.leaves || corner.meeting == corner.at;
    corner.at = middle.at;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const LoopNode &a = nodes[i], &b = nodes[(i + 1) % nodes.size()];
        const Polygon piece{0, 0, a.label, a.origin};
        const LoopNode all[] = {middle, a, b};
        const PiecePoint& side = sideOf(a, a.label);
        const Vec3f own = side.label == a.label ? normalized(side.gradient) : Vec3f{};
        middle.isBreak = true;
        emit(middle, a, b, piece, own == Vec3f{} ? normalized(newell(all)).as<float>() : own, out);
    }
}

void CellPieces::triangulate(PieceTriangles& out, std::vector<uint32_t>& cellEnds) {
    cellEnds.clear();
    uint32_t next = 0;
    for (const uint32_t end : cellEnds_) {
        const size_t triangles = out.triangles.size(), normals = out.cornerNormals.size();
        const Vec3i cell = loops_[next].cell;
        low_ = grid_->corner(cell.x, cell.y, cell.z), high_ = grid_->corner(cell.x + 1, cell.y + 1, cell.z + 1);
        places_.clear();
        bool good = true;
        for (uint32_t l = next; l < end && good; ++l) good = triangulateLoop(loops_[l], out);
        if (!good || crosses(out, triangles)) {
            // Fans of several loops may cross each other: then their middles are moved apart.
            for (const float apart : {0.0f, 0.5f, 1.0f, 2.0f, 4.0f}) {
                out.triangles.resize(triangles), out.labels.resize(triangles), out.origins.resize(triangles);
                out.cornerNormals.resize(normals);
                places_.clear();
                for (uint32_t l = next; l < end; ++l) fan(l, middleOf(next, end), apart, out);
                if (end - next == 1 || !crosses(out, triangles)) break;
            }
        }
        next = end;
        cellEnds.push_back(static_cast<uint32_t>(out.triangles.size()));
    }
    for (const Corner& corner : corners_) {
        Vec3f n{};
        for (const PiecePoint& plane : corner.planes) n += normalized(plane.gradient);
        if (corner.leaves)
            out.confined.push_back({firstVertex_ + static_cast<uint32_t>(&corner - corners_.data()), corner.meeting});
        out.positions.push_back(corner.at);
        out.normals.push_back(n == Vec3f{} ? Vec3f{0, 1, 0} : normalized(n));
    }
}

}  // namespace sgm::mesh
