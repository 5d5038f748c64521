#include "modeler/mesh/fine_cells.h"

#include <algorithm>
#include <iterator>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

Vec3i dividedBy(Vec3i index, int by) { return {index.x / by, index.y / by, index.z / by}; }

/// Leaves out all but some blocks on the way down.
class BlockFilter {
public:
    BlockFilter(CellSet blocks, const Grid& grid) {
        levels_.push_back(std::move(blocks));
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

}  // namespace

Grid halved(const Grid& grid, int halvings) {
    const int parts = 1 << halvings;
    return {grid.origin, grid.cell_m / static_cast<float>(parts), grid.cells * parts};
}

FineCells::FineCells(const eval::Tape& field, const Grid& grid, int halvings, int threads, Progress* progress)
    : field_(field), fine_(halved(grid, halvings)), halvings_(halvings), threads_(threads), progress_(progress) {}

Vec3i FineCells::blockOf(Vec3i cell) const { return dividedBy(cell * (1 << halvings_), blockCells); }

Status FineCells::add(std::span<const Vec3i> cells) {
    if (Status status = checkGrid(fine_); !status) return status;
    CellSet asked, missing;
    for (const Vec3i cell : cells) {
        const Vec3i block = blockOf(cell);
        if (!held_.insert(block)) continue;
        asked.insert(block);
        for (int below = 0; below < 8; ++below) {  // vertices on a block's low sides belong to the blocks below it
            const Vec3i lender = block - Vec3i{below & 1, below >> 1 & 1, below >> 2};
            if (minComponent(lender) >= 0 && made_.insert(lender)) missing.insert(lender);
        }
    }
    if (!missing.empty())
        if (Status status = mesh(std::move(missing)); !status) return status;
    for (const Vec3i block : asked.list()) {
        const auto at = std::lower_bound(chunks_.begin(), chunks_.end(), block,
                                         [](const Chunk& c, Vec3i index) { return zyxLess(c.block, index); });
        if (at == chunks_.end() || at->block != block) continue;
        numberGhosts(chunks_, *at);
        appendTriangles(surface_, *at);
    }
    return Done{};
}

/// Meshes blocks and adds their vertices.
Status FineCells::mesh(CellSet missing) {
    const BlockFilter wanted(std::move(missing), fine_);
    const RegionFilter filter{[&](std::span<const Vec3i> indices, int size) { return wanted.skips(indices, size); },
                              {}};
    Counts counts;
    const auto blocks = subdivide(field_, fine_, threads_, progress_, counts, filter);
    if (!blocks.ok()) return blocks.error();
    PolygonizeOptions options;
    options.surface = Surface::Crisp, options.threads = threads_;
    auto chunks = meshBlocks(*blocks, fine_, options, progress_, counts);
    if (!chunks.ok()) return chunks.error();
    for (Chunk& c : *chunks) {
        c.firstVertex = static_cast<uint32_t>(surface_.positions.size());
        if (c.firstVertex + c.positions.size() >= ghostBit)
            return Error{Error::Kind::Budget, "the mesh has more than 2^31 vertices: choose larger cells"};
        appendVertices(surface_, c);
    }
    const auto before = static_cast<ptrdiff_t>(chunks_.size());
    std::move(chunks->begin(), chunks->end(), std::back_inserter(chunks_));
    std::inplace_merge(chunks_.begin(), chunks_.begin() + before, chunks_.end(),
                       [](const Chunk& a, const Chunk& b) { return zyxLess(a.block, b.block); });
    return Done{};
}

}  // namespace sgm::mesh
