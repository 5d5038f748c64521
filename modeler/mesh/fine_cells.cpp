#include "modeler/mesh/fine_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

Vec3i dividedBy(Vec3i index, int by) { return {index.x / by, index.y / by, index.z / by}; }

/// Leaves out all but some blocks on the way down.
class BlockFilter {
public:
    BlockFilter(const CellSet& blocks, const Grid& grid) {
        levels_.push_back(blocks);
        for (int size = regionSplits; size <= blocksOfRoot(grid); size *= regionSplits) {
            CellSet above;
            for (const Vec3i index : levels_.back().list()) above.insert(dividedBy(index, regionSplits));
            levels_.push_back(std::move(above));
        }
    }
    uint64_t skips(std::span<const Vec3i> indices, int blocks) const {
        size_t level = 0;
        for (int size = 1; size < blocks; size *= regionSplits) ++level;
        uint64_t skipped = 0;
        for (size_t i = 0; i < indices.size() && level < levels_.size(); ++i)
            skipped |= static_cast<uint64_t>(!levels_[level].contains(indices[i])) << i;
        return skipped;
    }

private:
    std::vector<CellSet> levels_;  ///< blocks, and the regions of regionSplits times the edge of those before
};

/// Calls `visit` with a cube of cells and those that meet it, from other blocks, on sides of its block.
template <class Visit>
void visitAcrossBlocks(Vec3i cube, int cubesAlong, Visit&& visit) {
    std::array<std::array<int, 2>, 3> places{};
    std::array<size_t, 3> count{1, 1, 1};
    for (size_t axis = 0; axis < 3; ++axis) {
        const int own = cube[static_cast<int>(axis)], inBlock = own % cubesAlong;
        places[axis] = {own, inBlock == 0 ? own - 1 : own + 1};
        if ((inBlock == 0 && own > 0) || inBlock == cubesAlong - 1) count[axis] = 2;
    }
    for (size_t k = 0; k < count[2]; ++k)
        for (size_t j = 0; j < count[1]; ++j)
            for (size_t i = 0; i < count[0]; ++i) visit(Vec3i{places[0][i], places[1][j], places[2][k]});
}

}  // namespace

/// Those parts of blocks that are to be meshed.
class PartsOfBlocks {
public:
    explicit PartsOfBlocks(int cubeCells) : cubeCells_(cubeCells) {}

    /// Adds a cube of cells, and the bricks whose vertices it shares: those on its low sides belong to the bricks
    /// below.
    void add(Vec3i cube) {
        const int along = brickCells / cubeCells_;
        const Vec3i brick = dividedBy(cube, along), inBrick = cube - brick * along;
        const uint64_t bit = uint64_t{1} << (inBrick.x + along * (inBrick.y + along * inBrick.z));
        uint64_t& cubes = partWith(brick).cubes[numberInBlock(brick)];
        const bool isKnown = cubes != 0;
        cubes |= bit;
        if (isKnown) return;
        for (int below = 0; below < 8; ++below) {
            const Vec3i lender = brick - Vec3i{below & 1, below >> 1 & 1, below >> 2};
            if (minComponent(lender) < 0) continue;
            visitAcrossBlocks(lender, bricksAlong,
                              [&](Vec3i lent) { partWith(lent).bricks |= uint64_t{1} << numberInBlock(lent); });
        }
    }

    bool empty() const { return parts_.empty(); }
    const CellSet& blocks() const { return blocks_; }
    std::shared_ptr<const PartOfBlock> of(Vec3i block) const { return parts_[number_.find(block)]; }

private:
    static size_t numberInBlock(Vec3i brick) {
        return static_cast<size_t>(brickNumber(brick - dividedBy(brick, bricksAlong) * bricksAlong));
    }
    PartOfBlock& partWith(Vec3i brick) {
        const Vec3i block = dividedBy(brick, bricksAlong);
        uint32_t& number = number_[block];
        if (number == CellNumbers::none) {
            number = static_cast<uint32_t>(parts_.size());
            parts_.push_back(std::make_shared<PartOfBlock>());
            parts_.back()->cubeCells = cubeCells_;
            blocks_.insert(block);
        }
        return *parts_[number];
    }

    const int cubeCells_;
    CellSet blocks_;
    CellNumbers number_;
    std::vector<std::shared_ptr<PartOfBlock>> parts_;
};

Grid halved(const Grid& grid, int halvings) {
    const int parts = 1 << halvings;
    return {grid.origin, grid.cell_m / static_cast<float>(parts), grid.cells * parts};
}

FineCells::FineCells(const eval::Tape& field, const Grid& grid, int halvings, int threads, Progress* progress)
    : field_(field),
      grid_(grid),
      fine_(halved(grid, halvings)),
      halvings_(halvings),
      threads_(threads),
      progress_(progress) {}

Status FineCells::add(std::span<const Vec3i> cells) {
    if (Status status = checkGrid(fine_); !status) return status;
    PartsOfBlocks parts(1 << halvings_);
    for (const Vec3i cell : cells)
        if (!has(cell) && isInGrid(grid_, cell))
            visitAcrossBlocks(cell, blockCells >> halvings_, [&](Vec3i other) {
                if (meshed_.insert(other)) parts.add(other);
            });
    if (parts.empty()) return Done{};
    Result<Chunk> added = meshParts(parts);
    return added.ok() ? append(std::move(*added)) : added.error();
}

/// Shortens the field to blocks that weren't asked for before.
Status FineCells::findBlocks(const CellSet& indices) {
    CellSet missing;
    for (const Vec3i index : indices.list())
        if (asked_.insert(index)) missing.insert(index);
    if (missing.empty()) return Done{};
    const BlockFilter wanted(missing, fine_);
    const RegionFilter filter{[&](std::span<const Vec3i> indices, int size) { return wanted.skips(indices, size); },
                              {}};
    Counts counts;
    auto found = subdivide(field_, fine_, threads_, progress_, counts, filter);
    if (!found.ok()) return found.error();
    const auto before = static_cast<ptrdiff_t>(blocks_.size());
    std::move(found->begin(), found->end(), std::back_inserter(blocks_));
    std::inplace_merge(blocks_.begin(), blocks_.begin() + before, blocks_.end(),
                       [](const Block& a, const Block& b) { return zyxLess(a.index, b.index); });
    return Done{};
}

/// The surface in parts of blocks, its vertices numbered from 0 on.
Result<Chunk> FineCells::meshParts(const PartsOfBlocks& parts) {
    if (Status status = findBlocks(parts.blocks()); !status) return status.error();
    std::vector<Block*> sources;
    std::vector<Block> blocks;
    for (Block& block : blocks_) {
        if (!parts.blocks().contains(block.index)) continue;
        sources.push_back(&block);
        blocks.push_back(std::move(block));
        blocks.back().part = parts.of(blocks.back().index);
    }
    PolygonizeOptions options;
    options.surface = Surface::Crisp, options.threads = threads_;
    Counts counts;
    auto chunks = meshBlocks(blocks, fine_, options, progress_, counts);
    for (size_t b = 0; b < blocks.size(); ++b) *sources[b] = std::move(blocks[b]);
    if (!chunks.ok()) return chunks.error();
    Numbering numbering;
    if (Status status = numbering.add(*chunks); !status) return status.error();
    for (Chunk& c : *chunks) numberGhosts(*chunks, c);
    Chunk made = joinChunks(Mesh{std::move(*chunks)});
    dropUnusedVertices(made);
    return made;
}

bool FineCells::isOnSide(Vec3f p) const {
    for (int axis = 0; axis < 3; ++axis) {
        const int nearest = static_cast<int>(std::lround((p[axis] - grid_.origin[axis]) / grid_.cell_m));
        if (grid_.corner(nearest, nearest, nearest)[axis] == p[axis]) return true;
    }
    return false;
}

/// Adds a surface that has the vertices of the one that is there, bit by bit, where they meet on sides of cells.
Status FineCells::append(Chunk added) {
    if (surface_.positions.size() + added.positions.size() >= ghostBit)
        return Error{Error::Kind::Budget, "the mesh has more than 2^31 vertices: choose larger cells"};
    const auto before = static_cast<uint32_t>(surface_.positions.size());
    std::vector<uint32_t> number(added.positions.size());
    uint32_t count = before;
    for (uint32_t v = 0; v < number.size(); ++v) {
        const Vec3f p = added.positions[v];
        if (isOnSide(p)) {
            const auto [at, isNew] = onSides_.try_emplace(p, count);
            const bool isShared = !isNew && at->second < before;  // two that are added stay two, wherever they are
            number[v] = isShared ? at->second : count;
            if (isShared) continue;
        } else {
            number[v] = count;
        }
        ++count;
        surface_.positions.push_back(p), surface_.normals.push_back(added.normals[v]);
    }
    for (const ConfinedVertex& v : added.confined)
        if (number[v.vertex] >= before) surface_.confined.push_back({number[v.vertex], v.place});
    for (const uint32_t v : added.faceted)
        if (number[v] >= before) surface_.faceted.push_back(number[v]);
    for (Triangle& t : added.triangles) t = {number[t.x], number[t.y], number[t.z]};
    appendTriangles(surface_, added);
    return Done{};
}

}  // namespace sgm::mesh
