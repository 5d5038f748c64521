#include "grammar/pipeline/baked_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/chunk.h"
#include "modeler/tiles/skirt.h"

namespace sgm::pipeline {
namespace {

using tiles::Cell;

constexpr int mostCells = 1 << 15;  ///< along an axis of one grid

double below(double v, double step) { return std::floor(v / step) * step; }

/// Whether sums of such steps are exact in float32 as far as a model may reach.
bool isExact(double step) {
    int exponent = 0;
    return std::frexp(step, &exponent) == .5 && exponent > -12;
}

/// A cell's blocks in a grid: columns [x, x + side) × [z, z + side).
struct Columns {
    int x, z, side;
    bool has(int bx, int bz) const { return bx >= x && bx < x + side && bz >= z && bz < z + side; }
    /// Whether a region of `size` blocks touches them, or the ring below, which lends vertices.
    bool touches(int x0, int z0, int size) const {
        return x0 < x + side && x0 + size > x - 1 && z0 < z + side && z0 + size > z - 1;
    }
};

/// The chunks of some cells, as one list of vertices with the triangles of each cell.
struct Gathered {
    mesh::PackedMesh mesh;
    std::vector<std::vector<uint32_t>> triangles;  ///< by cell of the group
};

Gathered gather(std::vector<mesh::Chunk> chunks, const std::vector<Columns>& cells) {
    Gathered out;
    out.triangles.resize(cells.size());
    mesh::Numbering numbering;
    static_cast<void>(numbering.add(chunks));
    for (mesh::Chunk& chunk : chunks) {
        out.mesh.positions.insert(out.mesh.positions.end(), chunk.positions.begin(), chunk.positions.end());
        out.mesh.normals.insert(out.mesh.normals.end(), chunk.normals.begin(), chunk.normals.end());
        const auto owner = std::find_if(cells.begin(), cells.end(),
                                        [&](const Columns& c) { return c.has(chunk.block.x, chunk.block.z); });
        if (owner == cells.end()) continue;
        auto& list = out.triangles[static_cast<size_t>(owner - cells.begin())];
        mesh::numberGhosts(chunks, chunk);
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            list.push_back(static_cast<uint32_t>(out.mesh.triangles.size()));
            out.mesh.triangles.push_back(chunk.inMesh(chunk.triangles[t]));
            out.mesh.origins.push_back(chunk.origins[t]);
        }
    }
    return out;
}

/// The square of four by four whose ground is made together.
Cell squareOf(const Cell& cell) { return cell.parent().parent(); }

/// The box around pieces about `centre` and what hangs from them, in the model's frame.
Box3f spaceOf(const std::vector<tiles::SurfacePiece>& pieces, Vec3d centre, double depth_m) {
    const Box3f box = tiles::boundsOf(pieces);
    const Vec3d margin{depth_m + 1, depth_m + 1, depth_m + 1};
    return {(box.lo.as<double>() + centre - margin).as<float>(), (box.hi.as<double>() + centre + margin).as<float>()};
}

/// The tape without what can't matter in a box.
eval::Tape within(const eval::Tape& tape, const Box3f& box, eval::Workspace& workspace) {
    eval::FloatInterval range;
    const eval::RangeTrace trace = eval::evaluateRanges(tape, {&box, 1}, &range, workspace);
    return eval::shorten(tape, trace, 0, workspace);
}

}  // namespace

std::vector<Cell> BakedGround::groupOf(const std::vector<Cell>& cells) {
    std::vector<Cell> group;
    for (const Cell& cell : cells)
        if (cell.level == cells.front().level && squareOf(cell) == squareOf(cells.front())) group.push_back(cell);
    return group;
}

Status BakedGround::check() const {
    const Box3f& box = model_.lowered->field.bounds;
    if (box.empty() || isExact(request_.cell_m)) return Done{};
    const double extent =
        static_cast<double>(maxComponent(box.hi - box.lo)) + 2 * request_.side_m * (1 << (request_.levels - 1));
    if (extent / request_.cell_m <= mostCells) return Done{};
    return Error{Error::Kind::Usage,
                 fmt::format("{:.0f} m are more than {} cells of {} m; so many are exact for powers of two alone: take "
                             "--cell {}",
                             extent, mostCells, request_.cell_m, std::exp2(std::round(std::log2(request_.cell_m))))};
}

/// One grid for the whole model, or, where that has too many cells, one over the group and what is around it, whose
/// corners are the same to the last bit.
mesh::Grid BakedGround::gridOver(const std::vector<Cell>& group, Vec3i& corner) const {
    const Box3f& box = model_.lowered->field.bounds;
    const double pitch = pitch_m(group.front().level), block = pitch * mesh::blockCells;
    const double top = request_.side_m * (1 << (request_.levels - 1)), margin = 2 * pitch;
    Vec3d lo = box.lo.as<double>() - Vec3d{margin, margin, margin};
    Vec3d hi = box.hi.as<double>() + Vec3d{margin, margin, margin};
    const double side = group.front().side_m(request_.side_m);
    Vec3d origin{below(lo.x, top), below(lo.y, pitch), below(lo.z, top)};
    Vec3d near{1e300, 0, 1e300}, far{-1e300, 0, -1e300};
    for (const Cell& cell : group) {
        const Vec3d c = cell.centre(request_.side_m);
        near = min(near, c - Vec3d{side / 2, 0, side / 2}), far = max(far, c + Vec3d{side / 2, 0, side / 2});
    }
    if (std::max(hi.x - origin.x, hi.z - origin.z) / pitch > mostCells) {
        origin.x = near.x - 2 * block, origin.z = near.z - 2 * block;
        hi.x = far.x + block, hi.z = far.z + block;
    }
    mesh::Grid grid;
    grid.cell_m = static_cast<float>(pitch);
    grid.origin = origin.as<float>();
    for (int axis = 0; axis < 3; ++axis)
        grid.cells[axis] = static_cast<int>(std::ceil((hi[axis] - origin[axis]) / pitch));
    corner = {static_cast<int>(std::lround(origin.x / block)), 0, static_cast<int>(std::lround(origin.z / block))};
    return grid;
}

Result<std::map<Cell, std::vector<tiles::SurfacePiece>>> BakedGround::make(const std::vector<Cell>& group,
                                                                           Context& context) {
    std::map<Cell, std::vector<tiles::SurfacePiece>> made;
    if (model_.lowered->field.bounds.empty() || group.empty()) return made;
    Vec3i corner;
    const mesh::Grid grid = gridOver(group, corner);
    const double pitch = pitch_m(group.front().level), side = group.front().side_m(request_.side_m);
    const int blocks = static_cast<int>(std::lround(side / pitch / mesh::blockCells));
    std::vector<Columns> cells;
    for (const Cell& cell : group) cells.push_back({cell.x * blocks - corner.x, cell.z * blocks - corner.z, blocks});
    mesh::RegionFilter filter;
    filter.skips = [&](std::span<const Vec3i> indices, int size) {
        uint64_t skipped = 0;
        for (size_t i = 0; i < indices.size(); ++i)
            if (std::none_of(cells.begin(), cells.end(), [&](const Columns& c) {
                    return c.touches(indices[i].x * size, indices[i].z * size, size);
                }))
                skipped |= uint64_t{1} << i;
        return skipped;
    };
    mesh::Counts counts;
    const eval::Tape& tape = tapes_.over(squareOf(group.front()), workspace_);
    const auto found = mesh::subdivide(tape, grid, context.threads, context.progress, counts, filter);
    if (!found.ok()) return found.error();
    mesh::PolygonizeOptions options{.surface = mesh::Surface::Crisp, .threads = context.threads};
    auto chunks = mesh::meshBlocks(*found, grid, options, context.progress, counts);
    if (!chunks.ok()) return chunks.error();
    const Gathered gathered = gather(std::move(*chunks), cells);
    Box3f space;
    for (size_t i = 0; i < group.size(); ++i) {
        const Vec3d centre = group[i].centre(request_.side_m);
        auto& pieces = made[group[i]] =
            tiles::groundPieces(gathered.mesh, gathered.triangles[i], model_.lowered->provenance, centre, pitch);
        if (!pieces.empty()) space = hull(space, spaceOf(pieces, centre, pitch / 2));
    }
    if (request_.levels < 2 || space.empty()) return made;
    const eval::Tape around = within(tape, space, workspace_);
    for (auto& [cell, pieces] : made)
        if (!pieces.empty()) addSkirts(cell, around, pieces);
    return made;
}

void BakedGround::addSkirts(const Cell& cell, const eval::Tape& around, std::vector<tiles::SurfacePiece>& pieces) {
    const Vec3d centre = cell.centre(request_.side_m);
    // Surfaces of neighbouring levels are closer to each other than half a cell of the finer one's grid.
    const double depth = pitch_m(cell.level) / 2;
    const eval::Tape tape = within(around, spaceOf(pieces, centre, depth), workspace_);
    const tiles::InsideTest inside = [&](const std::vector<Vec3d>& places) {
        std::vector<float> x, y, z, value(places.size());
        for (const Vec3d& place : places) {
            const Vec3f p = (place + centre).as<float>();
            x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
        }
        if (!places.empty()) eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, value.data(), workspace_);
        std::vector<bool> is;
        for (const float v : value) is.push_back(v < 0);
        return is;
    };
    const tiles::SkirtRequest request{cell.side_m(request_.side_m), depth, inside};
    for (tiles::SurfacePiece& piece : pieces) tiles::addSkirts(piece, request);
}

tiles::QuantizationGrid BakedGround::placesOf(const Cell& cell) const {
    const double side = cell.side_m(request_.side_m), step = std::ldexp(side, -15);
    const Box3f& box = model_.lowered->field.bounds;
    if (box.empty()) return {};
    const double margin = 4 * pitch_m(request_.levels - 1), lowest = static_cast<double>(box.lo.y) - margin;
    const double height = tiles::stepOver(static_cast<double>(box.hi.y) + margin - lowest + 1);
    return {{-side / 2, below(lowest, height), -side / 2}, {step, height, step}};
}

}  // namespace sgm::pipeline
