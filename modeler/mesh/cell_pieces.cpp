#include "modeler/mesh/cell_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace sgm::mesh {
namespace {

constexpr uint32_t cornerVertex = 0xffffffffu;  ///< stands for a loop's corner until that is placed
constexpr float probeShare = 0.0625f;
constexpr int cornerRounds = 3;
constexpr float settledShare = 1e-4f;    ///< of a cell, within which a corner may still move
constexpr float confirmShare = 0x1p-8f;  ///< of a cell times the slope: the field at a confirmed corner
constexpr float apartShare = 0.03f;      ///< of a cell, from a corner to each of its planes
constexpr int surfaceSteps = 3;          ///< of Newton's method
constexpr float flatCosine = 0.99999f;   ///< between the normals of pieces in one plane
constexpr float smoothCosine = 0.9999f;  ///< between those of two pieces where they meet without a crease
constexpr int flatParts = 7;             ///< of either side of the grid on which corners are looked for
constexpr int flatRounds = 4;
constexpr double towardsMiddle = 1e-6;  ///< weight of the nodes' middle where planes leave a corner open

/// x of A x = b by Cramer's rule, for a symmetric positive definite A.
Vec3d solved(const std::array<Vec3d, 3>& rows, Vec3d b) {
    const double det = dot(rows[0], cross(rows[1], rows[2]));
    if (!(std::abs(det) > 0)) return {};
    return (cross(rows[1], rows[2]) * b.x + cross(rows[2], rows[0]) * b.y + cross(rows[0], rows[1]) * b.z) / det;
}

bool lieInOnePlane(std::span<const PiecePoint> pieces) {
    const Vec3f first = normalized(pieces[0].gradient);
    return std::all_of(pieces.begin(), pieces.end(),
                       [&](const PiecePoint& piece) { return dot(first, normalized(piece.gradient)) > flatCosine; });
}

double squares(const LoopNode& a, const LoopNode& b) {
    const Vec3d d = (b.at - a.at).as<double>();
    return dot(d, d);
}

}  // namespace

Vec3f inCell(const Grid& grid, Vec3i cell, Vec3f p) {
    const Vec3f low = grid.corner(cell.x, cell.y, cell.z), high = grid.corner(cell.x + 1, cell.y + 1, cell.z + 1);
    const Vec3f margin = (high - low) * 0x1.0p-8f;
    return max(low + margin, min(high - margin, p));
}

void CellPieces::clear() {
    nodes_.clear(), polygons_.clear(), loops_.clear(), cellEnds_.clear();
    corners_.clear();
}

void CellPieces::Corners::clear() {
    spare.insert(spare.end(), std::move_iterator(list.begin()), std::move_iterator(list.end()));
    list.clear();
}

CellPieces::Corner& CellPieces::Corners::add() {
    Corner& corner = list.emplace_back();
    if (spare.empty()) return corner;
    corner.planes.swap(spare.back().planes), corner.planes.clear();
    corner.labels.swap(spare.back().labels), corner.labels.clear();
    corner.means.swap(spare.back().means), corner.means.clear();
    spare.pop_back();
    return corner;
}

void CellPieces::addPolygon(std::span<const LoopNode> nodes) {
    if (nodes.size() < 3) return;  // a piece that only touches the cell's face
    const auto first = static_cast<uint32_t>(nodes_.size());
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    polygons_.push_back({first, static_cast<uint32_t>(nodes_.size()), nodes[0].label, nodes[0].origin});
}

void CellPieces::addLoop(Vec3i cell, size_t brick, std::span<const LoopNode> nodes) {
    Loop loop{cell, brick, static_cast<uint32_t>(nodes_.size()), 0, 0, 0, -1};
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
    std::vector<size_t>& breaks = breaks_;
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
    loop.corner = static_cast<int32_t>(corners_.list.size());
    Corner& corner = corners_.add();
    corner.cell = loop.cell, corner.brick = loop.brick;
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

/// Those around which no border is a crease, as on blends; they are looked for by labels alone.
void CellPieces::findSmoothCorners() {
    for (Corner& corner : corners_.list) {
        const size_t count = corner.labels.size();
        // Of each piece there are the planes at its first and its last break, which is the next one's first.
        corner.isSmooth = count >= 3;
        for (size_t k = 0; k < count && corner.isSmooth; ++k) {
            const Vec3f own = normalized(corner.planes[2 * k + 1].gradient),
                        next = normalized(corner.planes[2 * ((k + 1) % count)].gradient);
            corner.isSmooth = dot(own, next) > smoothCosine;
        }
        corner.settled = corner.isSmooth;
        corner.meeting = corner.at;
    }
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
    corner.at = inCell(*grid_, corner.cell, corner.meeting);
}

/// Whether all planes of a corner pass near its meeting: in a cell with more of them than one corner has they needn't.
bool CellPieces::meets(const Corner& corner) const {
    return std::all_of(corner.planes.begin(), corner.planes.end(), [&](const PiecePoint& plane) {
        return std::abs(dot(normalized(plane.gradient), plane.at - corner.meeting)) <= apartShare * grid_->cell_m;
    });
}

/// Corners whose planes don't meet go to the surface nearby, inside their cells: what is nearest to all planes may lie
/// beyond it. Returns how often the field was evaluated.
uint64_t CellPieces::moveToSurface(const BlockTapes& tapes, eval::Workspace& workspace) {
    std::vector<Corner*> apart;
    for (Corner& corner : corners_.list)
        if (corner.meeting == corner.at && (corner.isSmooth || !meets(corner))) apart.push_back(&corner);
    for (int step = 0; step < surfaceSteps && !apart.empty(); ++step) {
        probes_.clear();
        for (const Corner* corner : apart) probes_.add(tapes, corner->brick, corner->at);
        probes_.evaluate(workspace);
        for (size_t i = 0; i < apart.size(); ++i) {
            float value;
            const Vec3f g = probes_.point(i, value).gradient;
            if (const float square = dot(g, g); square > 0 && std::abs(value) < std::sqrt(square) * grid_->cell_m)
                apart[i]->at = inCell(*grid_, apart[i]->cell, apart[i]->at - g * (value / square));
            apart[i]->meeting = apart[i]->at;
        }
    }
    return apart.size() * surfaceSteps;
}

/// Corners of three pieces in one plane, or of more without creases, go to where their borders meet: the planes don't
/// tell. That is looked for on a grid, in the square with most of them again on a finer one. Returns how often the
/// field was evaluated.
uint64_t CellPieces::searchFlatCorners(const BlockTapes& tapes, eval::Workspace& workspace) {
    std::vector<FlatCorner> flat;
    for (Corner& corner : corners_.list)
        if (corner.isSmooth ||
            (corner.labels.size() == 3 && corner.meeting == corner.at && lieInOnePlane(corner.planes)))
            flat.push_back(squareAround(corner));
    uint64_t evaluations = 0;
    for (int round = 0; round < flatRounds && !flat.empty(); ++round) {
        probes_.clear();
        for (const FlatCorner& at : flat)
            for (int v = 0; v <= flatParts; ++v)
                for (int u = 0; u <= flatParts; ++u)
                    probes_.add(tapes, at.corner->brick, at.place(float(u) / flatParts, float(v) / flatParts));
        probes_.evaluate(workspace);
        evaluations += probes_.size();
        const size_t each = probes_.size() / flat.size();
        size_t kept = 0;
        for (size_t i = 0; i < flat.size(); ++i) {
            if (!narrow(flat[i], i * each)) continue;  // within the margin of ties walls show instead
            flat[i].corner->at = flat[i].corner->meeting =
                inCell(*grid_, flat[i].corner->cell, flat[i].place(0.5, 0.5));
            flat[kept++] = flat[i];
        }
        flat.resize(kept);
    }
    return evaluations;
}

/// Around all nodes of a corner's loop, in its plane.
CellPieces::FlatCorner CellPieces::squareAround(Corner& corner) const {
    Vec3f normal{};
    for (const PiecePoint& plane : corner.planes) normal += normalized(plane.gradient);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
    Box3f box;
    const Loop& loop = loops_[corner.loop];
    for (uint32_t i = loop.firstNode; i < loop.endNode; ++i) box = hull(box, {nodes_[i].at, nodes_[i].at});
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto along = [&](int a) {
        Vec3f way{};
        way[a] = box.hi[a] - box.lo[a];
        way[axis] = -way[a] * normal[a] / normal[axis];
        return way;
    };
    Vec3f low = corner.at;
    low[axis] += ((low[u] - box.lo[u]) * normal[u] + (low[v] - box.lo[v]) * normal[v]) / normal[axis];
    low[u] = box.lo[u], low[v] = box.lo[v];
    return {&corner, low, along(u), along(v)};
}

/// Puts the square of the grid with most pieces, three or more, in the place of all of it; false where none has. The
/// grid's points are samples from `sample` on.
bool CellPieces::narrow(FlatCorner& flat, size_t sample) const {
    constexpr size_t row = flatParts + 1;
    const auto& labels = flat.corner->labels;
    std::array<unsigned, row * row> seen;  // a bit for each piece
    for (size_t i = 0; i < seen.size(); ++i) {
        float value;
        const PiecePoint point = probes_.point(sample + i, value);
        seen[i] = 0;
        for (size_t k = 0; k < labels.size(); ++k) seen[i] |= unsigned{point.label == labels[k]} << k;
    }
    size_t best = 0;
    int most = 2;
    for (size_t v = 0; v < flatParts; ++v)
        for (size_t u = 0; u < flatParts; ++u) {
            const size_t at = v * row + u;
            const int pieces = std::popcount(seen[at] | seen[at + 1] | seen[at + row] | seen[at + row + 1]);
            if (pieces > most) best = at, most = pieces;
        }
    if (most == 2) return false;
    const float margin = 0.1f, share = (1 + 2 * margin) / flatParts;
    flat.low = flat.place((float(best % row) - margin) / flatParts, (float(best / row) - margin) / flatParts);
    flat.alongU = flat.alongU * share, flat.alongV = flat.alongV * share;
    return true;
}

/// A meeting outside the cell counts where it lies on the surface, on one of the corner's pieces. Returns at how many
/// the field was evaluated.
uint64_t CellPieces::confirmMeetings(const BlockTapes& tapes, eval::Workspace& workspace) {
    probes_.clear();
    for (Corner& corner : corners_.list) {
        corner.leaves =
            corner.meeting != corner.at && length(corner.meeting - corner.at) <= Corner::reach * grid_->cell_m;
        if (corner.leaves) probes_.add(tapes, corner.brick, corner.meeting);
    }
    probes_.evaluate(workspace);
    size_t i = 0;
    for (Corner& corner : corners_.list) {
        if (!corner.leaves) continue;
        float value;
        const PiecePoint seen = probes_.point(i++, value);
        const auto& labels = corner.labels;
        corner.leaves = std::find(labels.begin(), labels.end(), seen.label) != labels.end() &&
                        std::abs(value) <= confirmShare * grid_->cell_m * length(seen.gradient);
    }
    return probes_.size();
}

/// Moves corners that aren't settled to where their pieces meet, as these are found near them. Returns how often the
/// field was evaluated.
uint64_t CellPieces::lookAtPlanes(const BlockTapes& tapes, eval::Workspace& workspace) {
    const float cell_m = grid_->cell_m;
    uint64_t evaluations = 0;
    std::vector<PiecePoint> seen;
    for (int round = 0; round < cornerRounds && !corners_.list.empty(); ++round) {
        probes_.clear();
        for (const Corner& corner : corners_.list) {
            if (corner.settled) continue;
            const bool isNear = length(corner.meeting - corner.at) <= Corner::reach * cell_m;
            const Vec3f from = round > 0 && isNear ? corner.meeting : corner.at;
            for (const Vec3f& mean : corner.means) probes_.add(tapes, corner.brick, from + (mean - from) * probeShare);
        }
        probes_.evaluate(workspace);
        evaluations += probes_.size();
        size_t i = 0;
        for (Corner& corner : corners_.list) {
            if (corner.settled) continue;
            seen.clear();
            corner.settled = true;
            for (size_t k = 0; k < corner.means.size(); ++k, ++i) {
                float found;
                PiecePoint plane = probes_.point(i, found);
                const double value = found;
                const Vec3d g = plane.gradient.as<double>();
                const double square = dot(g, g);
                if (plane.label == corner.labels[k] && square > 0 && std::abs(value) < std::sqrt(square) * cell_m) {
                    plane.at = (plane.at.as<double>() - g * (value / square)).as<float>();
                    seen.push_back(plane);
                } else {
                    corner.settled = false;
                    for (const PiecePoint& known : corner.planes)
                        if (known.label == corner.labels[k]) seen.push_back(known);
                }
            }
            corner.planes.swap(seen);
            const Vec3f before = corner.meeting;
            intersect(corner);
            corner.settled = corner.settled && length(corner.meeting - before) <= settledShare * cell_m;
        }
    }
    return evaluations;
}

uint64_t CellPieces::placeCorners(const BlockTapes& tapes, const Grid& grid, eval::Workspace& workspace,
                                  uint32_t firstVertex) {
    grid_ = &grid;
    firstVertex_ = firstVertex;
    findSmoothCorners();
    for (Corner& corner : corners_.list)
        if (!corner.settled) intersect(corner);
    uint64_t evaluations = lookAtPlanes(tapes, workspace);
    if (const uint64_t searched = borderCorners_.place(corners_.list, tapes, grid, workspace); searched > 0)
        evaluations += searched + lookAtPlanes(tapes, workspace);  // creases may be round
    evaluations += searchFlatCorners(tapes, workspace);
    evaluations += moveToSurface(tapes, workspace);
    evaluations += confirmMeetings(tapes, workspace);
    writeCorners();
    return evaluations;
}

/// Puts the corners into their polygons.
void CellPieces::writeCorners() {
    for (const Loop& loop : loops_) {
        if (loop.corner < 0) continue;
        const Corner& corner = corners_.list[static_cast<size_t>(loop.corner)];
        for (uint32_t p = loop.firstPolygon; p < loop.endPolygon; ++p)
            for (uint32_t i = polygons_[p].first; i < polygons_[p].end; ++i)
                if (nodes_[i].vertex == cornerVertex) {
                    nodes_[i].vertex = firstVertex_ + static_cast<uint32_t>(loop.corner);
                    nodes_[i].at = corner.at;
                    nodes_[i].isBreak = true;
                    for (const PiecePoint& plane : corner.planes)
                        if (plane.label == polygons_[p].label) nodes_[i].sides = {&plane, &plane};
                }
    }
}

}  // namespace sgm::mesh
