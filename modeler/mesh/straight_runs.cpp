#include "modeler/mesh/straight_runs.h"

#include <cmath>

namespace sgm::mesh {
namespace {

constexpr int leastCells = 4;              ///< of a run with its first and last one
constexpr double straightShare = 0x1p-10;  ///< of a cell: how far a run's breaks may differ across its axis

/// Whether two points differ along an axis alone, bit by bit.
bool isAlong(Vec3f a, Vec3f b, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return a[u] == b[u] && a[v] == b[v];
}

/// The side of a break on a piece.
const PiecePoint& sideOn(const Break& at, uint32_t label) { return at.sides[at.sides[0].label == label ? 0 : 1]; }

}  // namespace

uint32_t StraightRuns::placeAt(Vec3i low, int edge) const { return surface_->placeOf(surface_->vertexOf(low, edge)); }

/// A cell with one loop of four vertices, two on each of two pieces, that are the same at both of its ends.
StraightRuns::Way StraightRuns::wayThrough(const SurfaceCell& cell) const {
    const CellLoops& loops = loopTable()[cell.inside];
    if (loops.count != 1 || loops.loops[0].size != 4) return {};
    const CellLoop& loop = loops.loops[0];
    const Vec3i low = cornerIndices(cell.corner);
    for (size_t side = 0; side < 4; ++side) {
        if (loop.faces[side] % 2 == 0) continue;
        const int axis = loop.faces[side] / 2;
        const std::array<int, 4> edges{loop.edges[side], loop.edges[(side + 1) % 4], loop.edges[(side + 2) % 4],
                                       loop.edges[(side + 3) % 4]};
        std::array<uint32_t, 4> at;
        for (size_t i = 0; i < 4; ++i) at[i] = placeAt(low, edges[i]);
        const auto& labels = surface_->labels;
        const auto& positions = surface_->positions;
        if (labels[at[0]] == labels[at[3]] && labels[at[1]] == labels[at[2]] && labels[at[0]] != labels[at[1]] &&
            isAlong(positions[at[0]], positions[at[3]], axis) && isAlong(positions[at[1]], positions[at[2]], axis))
            return {axis, {edges[3], edges[2]}};
    }
    return {};
}

/// 1 + the place of the mixed cell at `low` where one is alike there, beside another along its axis; else 0.
uint32_t StraightRuns::neighbourOf(const std::vector<MixedCell>& mixed, uint32_t of, Vec3i low) const {
    const int axis = ways_[of].axis;
    if (low[axis] < 0 || low[axis] >= blockCells) return 0;
    const uint32_t number = mixedAt_[static_cast<size_t>(cornerNumber(low.x, low.y, low.z))];
    const bool isAlike = number != 0 && ways_[number - 1].axis == axis &&
                         surface_->cells[mixed[number - 1].cell].inside == surface_->cells[mixed[of].cell].inside;
    return isAlike ? number : 0;
}

/// The run that begins with a mixed cell, but for its first and last one.
void StraightRuns::addRun(std::vector<MixedCell>& mixed, uint32_t first) {
    const Way& way = ways_[first];
    const Vec3i step = stepAlong(way.axis), low = cornerIndices(surface_->cells[mixed[first].cell].corner);
    StraightRun run{low + step, way.axis, 0, way.edges, static_cast<uint32_t>(members_.size())};
    Vec3i at = run.low;
    for (uint32_t number; (number = neighbourOf(mixed, first, at)) != 0; at = at + step) members_.push_back(number - 1);
    const auto length = static_cast<int>(members_.size() - run.firstMember) + 1;
    if (length < leastCells) {
        members_.resize(run.firstMember);
        return;
    }
    members_.pop_back();
    run.cells = length - 2;
    for (size_t m = run.firstMember; m < members_.size(); ++m) mixed[members_[m]].isInRun = true;
    runs_.push_back(run);
}

void StraightRuns::find(const BlockSurface& surface, std::vector<MixedCell>& mixed) {
    surface_ = &surface;
    runs_.clear(), members_.clear(), ways_.clear();
    for (uint32_t m = 0; m < mixed.size(); ++m) {
        const SurfaceCell& cell = surface.cells[mixed[m].cell];
        ways_.push_back(wayThrough(cell));
        mixedAt_[cell.corner] = m + 1;
    }
    for (uint32_t m = 0; m < mixed.size(); ++m) {
        if (ways_[m].axis < 0) continue;
        const Vec3i low = cornerIndices(surface.cells[mixed[m].cell].corner);
        if (neighbourOf(mixed, m, low - stepAlong(ways_[m].axis)) == 0) addRun(mixed, m);
    }
    for (const MixedCell& m : mixed) mixedAt_[surface.cells[m.cell].corner] = 0;
}

/// The vertex of a piece at the k-th corner of a run.
uint32_t StraightRuns::vertexOf(const StraightRun& run, size_t piece, int k) const {
    return surface_->vertexOf(run.low + stepAlong(run.axis) * k, run.edges[piece]);
}

bool StraightRuns::isStraight(const StraightRun& run, const std::array<const Break*, 2>& ends) const {
    const Vec3d apart = (ends[1]->at - ends[0]->at).as<double>();
    const double most = straightShare * static_cast<double>(surface_->grid->cell_m);
    if (std::abs(apart[(run.axis + 1) % 3]) > most || std::abs(apart[(run.axis + 2) % 3]) > most) return false;
    for (const Break* const end : ends)
        if (end->at != end->crossing) return false;
    for (size_t piece = 0; piece < 2; ++piece) {
        const uint32_t low = surface_->placeOf(vertexOf(run, piece, 0)),
                       high = surface_->placeOf(vertexOf(run, piece, run.cells));
        const Vec3d from = surface_->positions[low].as<double>();
        const Vec3d way = (surface_->positions[high].as<double>() - from) * (piece == 0 ? 1.0 : -1.0);
        for (const Break* const end : ends) {
            const PiecePoint& side = sideOn(*end, surface_->labels[low]);
            if (side.label != surface_->labels[low]) return false;
            if (!(dot(cross(way, end->at.as<double>() - from), side.gradient.as<double>()) > 0)) return false;
        }
    }
    return true;
}

void StraightRuns::fill(const StraightRun& run, const std::array<RunEnd, 2>& ends, PieceTriangles& out) const {
    const int middle = run.cells / 2;
    for (size_t piece = 0; piece < 2; ++piece) {
        // Counter-clockwise, vertices of the piece before the break come from the low end, of that after it from the
        // high one.
        const RunEnd &near = ends[piece], &far = ends[1 - piece];
        const auto vertex = [&](int i) { return vertexOf(run, piece, piece == 0 ? i : run.cells - i); };
        const uint32_t place = surface_->placeOf(vertex(0)), label = surface_->labels[place];
        const auto add = [&](const Triangle& corners) {
            out.triangles.push_back(corners);
            out.labels.push_back(label), out.origins.push_back(surface_->origins[place]);
        };
        const auto addNormal = [&](const RunEnd& end, uint32_t corner) {
            const auto first = static_cast<uint32_t>(3 * (out.triangles.size() - 1));
            out.cornerNormals.push_back({first + corner, normalized(sideOn(*end.at, label).gradient)});
        };
        for (int i = 0; i < run.cells; ++i) {
            const RunEnd& end = i < middle ? near : far;
            add({vertex(i), vertex(i + 1), end.vertex});
            addNormal(end, 2);
        }
        add({vertex(middle), far.vertex, near.vertex});
        addNormal(far, 1), addNormal(near, 2);
    }
}

}  // namespace sgm::mesh
