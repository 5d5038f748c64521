#include "grammar/pipeline/baked_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "modeler/eval/evaluate.h"
#include "modeler/eval/region_cuts.h"
#include "modeler/mesh/chunk.h"
#include "modeler/mesh/region.h"
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

/// The cell whose tape a block is made with: the one that has it, else the first that needs it.
size_t makerOf(const std::vector<BlockColumns>& cells, int bx, int bz) {
    const auto owner = std::find_if(cells.begin(), cells.end(), [&](const BlockColumns& c) { return c.has(bx, bz); });
    if (owner != cells.end()) return static_cast<size_t>(owner - cells.begin());
    const auto first =
        std::find_if(cells.begin(), cells.end(), [&](const BlockColumns& c) { return c.touches(bx, bz, 1); });
    return static_cast<size_t>(first - cells.begin());
}

/// What a block of the ring lends: the bricks and cells at its high sides that a block of some cell meets; null for a
/// block of a cell, which is made whole.
std::shared_ptr<const mesh::PartOfBlock> partOf(const std::vector<BlockColumns>& cells, int bx, int bz) {
    const auto any = [&](int x, int z) {
        return std::any_of(cells.begin(), cells.end(), [&](const BlockColumns& c) { return c.has(x, z); });
    };
    if (any(bx, bz)) return nullptr;
    const bool beyondX = any(bx + 1, bz), beyondZ = any(bx, bz + 1), beyondBoth = any(bx + 1, bz + 1);
    mesh::PartOfBlock part{.cubeCells = 2};
    constexpr int cubes = mesh::brickCells / 2;
    uint64_t atX = 0, atZ = 0;  // cubes of a brick
    for (int cube = 0; cube < cubes * cubes * cubes; ++cube) {
        atX |= uint64_t{cube % cubes == cubes - 1} << cube;
        atZ |= uint64_t{cube / (cubes * cubes) == cubes - 1} << cube;
    }
    for (int number = 0; number < mesh::bricksPerBlock; ++number) {
        const Vec3i brick = mesh::brickAt(number);
        const bool lastX = brick.x == mesh::bricksAlong - 1, lastZ = brick.z == mesh::bricksAlong - 1;
        uint64_t& lent = part.cubes[static_cast<size_t>(number)];
        if (lastX && beyondX) lent |= atX;
        if (lastZ && beyondZ) lent |= atZ;
        if (lastX && lastZ && beyondBoth) lent |= atX & atZ;
        part.bricks |= uint64_t{lent != 0} << number;
    }
    return std::make_shared<const mesh::PartOfBlock>(part);
}

/// The chunks of some cells, as one list of vertices with the triangles of each cell.
struct Gathered {
    mesh::PackedMesh mesh;
    std::vector<std::vector<uint32_t>> triangles;  ///< by cell of the group
};

Gathered gather(std::vector<mesh::Chunk> chunks, const std::vector<BlockColumns>& cells) {
    Gathered out;
    out.triangles.resize(cells.size());
    mesh::Numbering numbering;
    static_cast<void>(numbering.add(chunks));
    const auto ownerOf = [&](const mesh::Chunk& chunk) {
        const auto owner = std::find_if(cells.begin(), cells.end(),
                                        [&](const BlockColumns& c) { return c.has(chunk.block.x, chunk.block.z); });
        return static_cast<size_t>(owner - cells.begin());
    };
    std::vector<size_t> count(cells.size() + 1, 0);  // a list that grows holds twice its size for a moment
    for (const mesh::Chunk& chunk : chunks) count[ownerOf(chunk)] += chunk.triangles.size();
    const size_t triangles = std::accumulate(count.begin(), count.end() - 1, size_t{0});
    out.mesh.positions.reserve(numbering.vertices), out.mesh.normals.reserve(numbering.vertices);
    out.mesh.triangles.reserve(triangles), out.mesh.origins.reserve(triangles);
    for (size_t i = 0; i < cells.size(); ++i) out.triangles[i].reserve(count[i]);
    for (mesh::Chunk& chunk : chunks) {
        out.mesh.positions.insert(out.mesh.positions.end(), chunk.positions.begin(), chunk.positions.end());
        out.mesh.normals.insert(out.mesh.normals.end(), chunk.normals.begin(), chunk.normals.end());
        const size_t owner = ownerOf(chunk);
        if (owner == cells.size()) continue;
        auto& list = out.triangles[owner];
        mesh::numberGhosts(chunks, chunk);
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            list.push_back(static_cast<uint32_t>(out.mesh.triangles.size()));
            out.mesh.triangles.push_back(chunk.inMesh(chunk.triangles[t]));
            out.mesh.origins.push_back(chunk.origins[t]);
        }
    }
    return out;
}

/// Finds which places on a cell's borders are inside the solid, with a tape for each border, for a cell's own is long.
class BorderTest {
public:
    /// `reach` is a box around what is asked for, about the cell's centre.
    BorderTest(const eval::Tape& ofCell, Vec3d centre, double half, const Box3f& reach, eval::Workspace& workspace)
        : ofCell_(ofCell), centre_(centre), half_(half), reach_(reach), workspace_(workspace) {}

    std::vector<bool> operator()(const std::vector<Vec3d>& places) {
        std::vector<bool> is(places.size());
        for (size_t border = 0; border < tapes_.size(); ++border) {
            std::vector<size_t> here;
            std::vector<float> x, y, z;
            for (size_t i = 0; i < places.size(); ++i) {
                if (borderOf(places[i]) != border) continue;
                const Vec3f p = (places[i] + centre_).as<float>();
                here.push_back(i), x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            }
            if (here.empty()) continue;
            std::vector<float> value(here.size());
            eval::evaluate(tapeAt(border), {x.data(), y.data(), z.data(), x.size()}, value.data(), workspace_);
            for (size_t i = 0; i < here.size(); ++i) is[here[i]] = value[i] < 0;
        }
        return is;
    }

private:
    /// Of low and high x, then of low and high z.
    size_t borderOf(const Vec3d& place) const {
        if (std::abs(place.x) == half_) return place.x < 0 ? 0 : 1;
        return place.z < 0 ? 2 : 3;
    }
    const eval::Tape& tapeAt(size_t border) {
        auto& tape = tapes_[border];
        if (tape) return *tape;
        const int axis = border < 2 ? 0 : 2;
        const Vec3d margin{1, 1, 1};
        Vec3d lo = reach_.lo.as<double>(), hi = reach_.hi.as<double>();
        lo[axis] = hi[axis] = border % 2 == 0 ? -half_ : half_;
        const Box3f box{(lo + centre_ - margin).as<float>(), (hi + centre_ + margin).as<float>()};
        return tape.emplace(eval::shortenTo(ofCell_, box, workspace_));
    }

    const eval::Tape& ofCell_;
    const Vec3d centre_;
    const double half_;
    const Box3f reach_;
    eval::Workspace& workspace_;
    std::array<std::optional<eval::Tape>, 4> tapes_;
};

}  // namespace

// Tapes hold a little beyond the ring below, which is a block wide.
BakedGround::BakedGround(const Model& model, const GroundRequest& request)
    : model_(model),
      request_(request),
      tapes_(model.tape, model.lowered->field.bounds, request.side_m,
             {1.125 * request.cell_m * mesh::blockCells, request.levels - 1}) {}

std::vector<Cell> BakedGround::groupOf(const std::vector<Cell>& cells) const {
    const Cell& first = cells.front();
    if (first.level > 0 && first.level == request_.levels - 1) return {first};
    std::vector<Cell> group;
    for (const Cell& cell : cells)
        if (cell.level == first.level && cell.parent() == first.parent()) group.push_back(cell);
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

/// Blocks with surface of some cells and of the rings below them, each found with the tape of its cell.
Result<std::vector<mesh::Block>> BakedGround::findBlocks(const std::vector<Cell>& group,
                                                         const std::vector<BlockColumns>& cells, const mesh::Grid& grid,
                                                         Context& context, mesh::Counts& counts) {
    std::vector<mesh::Block> blocks;
    for (size_t cell = 0; cell < cells.size(); ++cell) {
        mesh::RegionFilter filter;
        filter.skips = [&](std::span<const Vec3i> indices, int size) {
            uint64_t skipped = 0;
            for (size_t i = 0; i < indices.size(); ++i) {
                const int x = indices[i].x * size, z = indices[i].z * size;
                const bool isWanted = size == 1 ? makerOf(cells, x, z) == cell : cells[cell].touches(x, z, size);
                if (!isWanted) skipped |= uint64_t{1} << i;
            }
            return skipped;
        };
        auto some =
            mesh::subdivide(tapeOf(group[cell]), grid, context.threads, context.progress, counts, filter, &scratch_);
        if (!some.ok()) return some.error();
        std::move(some->begin(), some->end(), std::back_inserter(blocks));
    }
    for (mesh::Block& block : blocks) block.part = partOf(cells, block.index.x, block.index.z);
    std::sort(blocks.begin(), blocks.end(),
              [](const mesh::Block& a, const mesh::Block& b) { return mesh::zyxLess(a.index, b.index); });
    return blocks;
}

const eval::Tape& BakedGround::tapeOf(const Cell& cell) { return tapes_.over(cell, workspace_); }

Result<std::map<Cell, std::vector<tiles::SurfacePiece>>> BakedGround::make(const std::vector<Cell>& group,
                                                                           GroundParts* parts, Context& context) {
    std::map<Cell, std::vector<tiles::SurfacePiece>> made;
    if (model_.lowered->field.bounds.empty() || group.empty()) return made;
    Vec3i corner;
    const mesh::Grid grid = gridOver(group, corner);
    const double pitch = pitch_m(group.front().level), side = group.front().side_m(request_.side_m);
    const int blocks = static_cast<int>(std::lround(side / pitch / mesh::blockCells));
    std::vector<BlockColumns> cells;
    for (const Cell& cell : group) cells.push_back({cell.x * blocks - corner.x, cell.z * blocks - corner.z, blocks});
    mesh::Counts counts;
    auto found = findBlocks(group, cells, grid, context, counts);
    if (!found.ok()) return found.error();
    mesh::PolygonizeOptions options{.surface = mesh::Surface::Crisp, .threads = context.threads};
    auto chunks = mesh::meshBlocks(*found, grid, options, context.progress, counts);
    if (!chunks.ok()) return chunks.error();
    const Gathered gathered = gather(std::move(*chunks), cells);
    for (size_t i = 0; i < group.size(); ++i)
        made[group[i]] = tiles::groundPieces(gathered.mesh, gathered.triangles[i], model_.lowered->provenance,
                                             group[i].centre(request_.side_m), pitch);
    for (size_t i = 0; parts && i < group.size() && group[i].level == 0; ++i)
        parts->add(group[i], gathered.mesh, gathered.triangles[i]);
    if (request_.levels > 1)
        for (const Cell& cell : group)
            if (auto& pieces = made[cell]; !pieces.empty()) addSkirts(cell, pieces);
    if (group.front().level > 0) scratch_.clear(), workspace_ = eval::Workspace();  // as large as their tapes are long
    return made;
}

void BakedGround::addSkirts(const Cell& cell, std::vector<tiles::SurfacePiece>& pieces) {
    // Surfaces of neighbouring levels are closer to each other than half a cell of the finer one's grid.
    const double side = cell.side_m(request_.side_m), depth = pitch_m(cell.level) / 2;
    Box3f reach = tiles::boundsOf(pieces);
    const Vec3f margin = Vec3d{depth, depth, depth}.as<float>();
    reach = {reach.lo - margin, reach.hi + margin};
    BorderTest inside(tapeOf(cell), cell.centre(request_.side_m), side / 2, reach, workspace_);
    const tiles::SkirtRequest request{side, depth, std::ref(inside)};
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
