#include "modeler/mesh/cell_seams.h"

#include <algorithm>
#include <array>

namespace sgm::mesh {
namespace {

constexpr uint32_t noVertex = 0xffffffffu;
constexpr int cubeBits = 3;  ///< of the cells along a cube in which triangles wait
// In cells:
constexpr double nearest = 0.08;  ///< of two vertices that are one
constexpr double mostBent = 0.2;  ///< from a coarse edge to the fine vertices in its place

Vec3i cubeWith(Vec3i cell) { return {cell.x >> cubeBits, cell.y >> cubeBits, cell.z >> cubeBits}; }

/// An edge on a side, in the sense of the triangles in the side's cell.
struct SideEdge {
    uint32_t from, to, triangle;
};

float coordinateOf(const CellSide& side, const Grid& grid) {
    const int at = side.cell[side.axis] + (side.isHigh ? 1 : 0);
    return grid.corner(at, at, at)[side.axis];
}

/// The edges that the triangles in one of the cells at a side have on it, in the sense of the side's cell. An edge
/// between two of these triangles isn't one.
std::vector<SideEdge> edgesOn(const CellSide& side, const Grid& grid, SurfaceInCells& surface, bool isBeyond) {
    std::vector<SideEdge> edges;
    const float at = coordinateOf(side, grid);
    const Chunk& chunk = surface.surface();
    surface.visit(isBeyond ? side.beyond() : side.cell, [&](uint32_t t) {
        const Triangle& corners = chunk.triangles[t];
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = corners[k], b = corners[(k + 1) % 3];
            if (chunk.positions[a][side.axis] != at || chunk.positions[b][side.axis] != at) continue;
            const SideEdge edge{isBeyond ? b : a, isBeyond ? a : b, t};
            const auto same = std::find_if(edges.begin(), edges.end(),
                                           [&](const SideEdge& e) { return e.from == edge.to && e.to == edge.from; });
            if (same == edges.end())
                edges.push_back(edge);
            else
                edges.erase(same);
        }
    });
    return edges;
}

/// The cuts on one side.
class Seam {
public:
    Seam(const CellSide& side, const Grid& grid, SurfaceInCells& coarse, SurfaceInCells& fine)
        : side_(side),
          grid_(grid),
          coarse_(coarse.surface()),
          fine_(fine.surface()),
          coarseEdges_(edgesOn(side, grid, coarse, true)),
          fineEdges_(edgesOn(side, grid, fine, false)),
          isUsed_(fineEdges_.size()) {}

    std::optional<SeamFit> fit() {
        for (const SideEdge& e : coarseEdges_)
            if (!pairVertex(e.from) || !pairVertex(e.to)) return std::nullopt;
        for (const SideEdge& e : coarseEdges_)
            if (!walk(e)) return std::nullopt;
        if (std::find(isUsed_.begin(), isUsed_.end(), false) != isUsed_.end()) return std::nullopt;
        return std::move(made_);
    }

private:
    /// Which of the side's own edges a point lies on: 0 none, else 1 … 4.
    int borderOf(Vec3f p) const {
        int border = 0;
        for (int k = 1; k < 3; ++k) {
            const int axis = (side_.axis + k) % 3;
            for (int high = 0; high < 2; ++high) {
                const int at = side_.cell[axis] + high;
                if (p[axis] == grid_.corner(at, at, at)[axis]) border = 2 * k + high - 1;
            }
        }
        return border;
    }

    /// Whether the pieces before and after a vertex of a cut differ.
    static bool isBreak(uint32_t vertex, std::span<const SideEdge> edges, const Chunk& surface) {
        uint32_t before = noVertex, after = noVertex;
        for (const SideEdge& e : edges) {
            if (e.to == vertex) before = e.triangle;
            if (e.from == vertex) after = e.triangle;
        }
        return before != noVertex && after != noVertex && surface.labels[before] != surface.labels[after];
    }

    uint32_t fineOf(uint32_t vertex) const {
        for (const SeamFit::Pair& p : made_.vertices)
            if (p.coarse == vertex) return p.fine;
        return noVertex;
    }
    bool isTaken(uint32_t fine) const {
        return std::any_of(made_.vertices.begin(), made_.vertices.end(), [&](auto& p) { return p.fine == fine; });
    }

    /// Finds the fine vertex in the place of a coarse one: the nearest on the same edge of the side, or inside the side
    /// the nearest where pieces change as they do there.
    bool pairVertex(uint32_t vertex) {
        if (fineOf(vertex) != noVertex) return true;
        const Vec3f at = coarse_.positions[vertex];
        const int border = borderOf(at);
        const bool wantsBreak = border == 0 && isBreak(vertex, coarseEdges_, coarse_);
        const double farthest = nearest * static_cast<double>(grid_.cell_m);
        uint32_t found = noVertex;
        std::pair<bool, double> best{true, farthest};
        for (const SideEdge& e : fineEdges_)
            for (const uint32_t v : {e.from, e.to}) {
                const Vec3f place = fine_.positions[v];
                const auto way = static_cast<double>(length(place - at));
                if (!(way < farthest) || borderOf(place) != border) continue;
                const std::pair rank(wantsBreak && !isBreak(v, fineEdges_, fine_), way);
                if (rank < best) best = rank, found = v;
            }
        if (found == noVertex || isTaken(found)) return false;
        made_.vertices.push_back({vertex, found});
        return true;
    }

    /// Goes along the fine cut from one end of a coarse edge to the other.
    bool walk(const SideEdge& edge) {
        const uint32_t end = fineOf(edge.to);
        const Vec3d from = coarse_.positions[edge.from].as<double>(),
                    way = coarse_.positions[edge.to].as<double>() - from;
        SeamFit::Edge along{edge.triangle, edge.to, edge.from, {}};
        double share = 0;
        for (uint32_t at = fineOf(edge.from);;) {
            size_t next = 0;
            while (next < fineEdges_.size() && (fineEdges_[next].from != at || isUsed_[next])) ++next;
            if (next == fineEdges_.size()) return false;
            isUsed_[next] = true;
            at = fineEdges_[next].to;
            if (at == end) break;
            const Vec3d place = fine_.positions[at].as<double>() - from;
            const double here = dot(place, way) / dot(way, way);
            if (isTaken(at) || !(here >= share && here <= 1)) return false;
            if (!(length(place - way * here) <= mostBent * static_cast<double>(grid_.cell_m))) return false;
            share = here;
            along.inner.push_back(at);
        }
        std::reverse(along.inner.begin(), along.inner.end());
        made_.edges.push_back(std::move(along));
        return true;
    }

    const CellSide& side_;
    const Grid& grid_;
    const Chunk &coarse_, &fine_;
    std::vector<SideEdge> coarseEdges_, fineEdges_;
    std::vector<bool> isUsed_;  ///< of the fine edges
    SeamFit made_;
};

}  // namespace

Vec3i SurfaceInCells::cubeOf(uint32_t triangle) const {
    constexpr float cubeCells = 1 << cubeBits;
    constexpr float sure = 1e-2f;  // cells: farther from a cube's sides, rounding doesn't matter
    const Triangle& t = surface_.triangles[triangle];
    const Vec3f centre = (surface_.positions[t.x] + surface_.positions[t.y] + surface_.positions[t.z]) * (1.0f / 3);
    const Vec3f inCubes = (centre - grid_.origin) * (1 / (grid_.cell_m * cubeCells));
    const Vec3i cube{static_cast<int>(inCubes.x), static_cast<int>(inCubes.y), static_cast<int>(inCubes.z)};
    const Vec3f inside = inCubes - cube.as<float>();
    if (minComponent(inside) * cubeCells > sure && (1 - maxComponent(inside)) * cubeCells > sure) return cube;
    return cubeWith(cellOf(triangle));
}

void SurfaceInCells::follow() {
    const size_t known = before_.size();
    before_.resize(surface_.triangles.size());
    for (size_t t = known; t < before_.size(); ++t) {
        uint32_t& last = lastOfCube_[cubeOf(static_cast<uint32_t>(t))];
        before_[t] = last;
        last = static_cast<uint32_t>(t);
    }
}

void SurfaceInCells::sortCubeOf(Vec3i cell) {
    const Vec3i cube = cubeWith(cell);
    if (lastOfCube_.find(cube) == CellNumbers::none) return;
    std::vector<uint32_t> waiting;
    uint32_t& lastInCube = lastOfCube_[cube];
    for (uint32_t t = lastInCube; t != CellNumbers::none; t = before_[t]) waiting.push_back(t);
    lastInCube = CellNumbers::none;
    for (auto t = waiting.rbegin(); t != waiting.rend(); ++t) {
        uint32_t& last = lastOfCell_[cellOf(*t)];
        before_[*t] = last;
        last = *t;
    }
}

std::optional<SeamFit> fitSeam(const CellSide& side, const Grid& grid, SurfaceInCells& coarse, SurfaceInCells& fine) {
    return Seam(side, grid, coarse, fine).fit();
}

}  // namespace sgm::mesh
