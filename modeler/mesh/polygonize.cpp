#include "modeler/mesh/polygonize.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <span>
#include <string>

#include "modeler/core/parallel.h"
#include "modeler/core/stopwatch.h"
#include "modeler/mesh/chunk.h"

namespace sgm::mesh {
namespace {

/// Bytes the result holds so far, against the budget.
class Memory {
public:
    explicit Memory(uint64_t budget_bytes) : budget_(budget_bytes) {}
    void add(uint64_t bytes) { used_.fetch_add(bytes, std::memory_order_relaxed); }
    bool exceeded() const { return used_.load(std::memory_order_relaxed) > budget_; }
    Error error() const {
        return {Error::Kind::Budget, "the mesh needs more than the memory budget of " + std::to_string(budget_ >> 20) +
                                         " MiB: choose larger cells"};
    }

private:
    const uint64_t budget_;
    std::atomic<uint64_t> used_{0};
};

uint64_t bytesOf(const Chunk& c) {
    return sizeof(Chunk) + (c.positions.size() + c.normals.size()) * sizeof(Vec3f) +
           c.triangles.size() * sizeof(Triangle) + (c.origins.size() + c.labels.size()) * sizeof(OriginId) +
           c.cornerNormals.size() * sizeof(CornerNormal) + c.confined.size() * sizeof(ConfinedVertex) +
           (c.ghosts.vertices.size() + c.shared.vertices.size()) * sizeof(uint32_t);
}

/// The blocks' chunks without empty ones; ticks for every block.
Result<std::vector<Chunk>> chunksOf(std::span<const Block> blocks, const Grid& grid, const PolygonizeOptions& options,
                                    Progress* progress, Counts& counts) {
    if (Status status = checkGrid(grid); !status) return status.error();
    Memory memory(options.memoryBudget_bytes);
    const auto threads = static_cast<size_t>(threadCount(options.threads));
    std::vector<BlockMesher> workers;
    workers.reserve(threads);
    std::vector<eval::Tally> tallies(threads);
    for (size_t w = 0; w < threads; ++w) {
        workers.emplace_back(grid, options);
        if (options.tally) workers[w].tallyInto(&tallies[w]);
        if (options.timeField) workers[w].timeField();
    }
    std::vector<Chunk> chunks(blocks.size());
    parallelFor(blocks.size(), options.threads, progress, [&](size_t b, int worker) {
        if (memory.exceeded() || !workers[worker].mesh(blocks[b], progress, chunks[b])) return;
        memory.add(bytesOf(chunks[b]));
        tick(progress);
    });
    if (cancelled(progress)) return cancelledError();
    if (memory.exceeded()) return memory.error();
    Counts counted;
    for (const BlockMesher& w : workers) counted += w.counts();
    counted.sampleSeconds /= static_cast<double>(threads);
    counted.polygonizeSeconds /= static_cast<double>(threads);
    counted.field.seconds /= static_cast<double>(threads);
    counts += counted;
    for (const eval::Tally& tally : tallies)
        for (const auto& [operation, points] : tally) (*options.tally)[operation] += points;
    std::erase_if(chunks, [](const Chunk& c) { return c.triangles.empty() && c.positions.empty(); });
    return chunks;
}

/// Up to three layers of chunks: one that was passed on and owns, one to be completed, one with ghosts of it.
class Layers {
public:
    explicit Layers(const ChunkVisitor& visit) : visit_(visit) {}

    /// Takes the layer at `z`, ascending, and passes on the one below it.
    Status add(int z, std::vector<Chunk> layer) {
        if (z != z_ + 1)
            if (Status status = finish(); !status) return status;
        z_ = z;
        if (Status status = numbering_.add(layer); !status) return status;
        const size_t before = window_.chunks.size();
        std::move(layer.begin(), layer.end(), std::back_inserter(window_.chunks));
        for (size_t c = before; c < window_.chunks.size(); ++c) numberGhosts(window_.chunks, window_.chunks[c]);
        if (Status status = handOn(before); !status) return status;
        window_.chunks.erase(window_.chunks.begin(), window_.chunks.begin() + static_cast<ptrdiff_t>(handedOn_));
        handedOn_ = before - handedOn_;
        return Done{};
    }
    /// Hands on what is left.
    Status finish() {
        if (Status status = handOn(window_.chunks.size()); !status) return status;
        window_.chunks.clear();
        handedOn_ = 0;
        return Done{};
    }

private:
    /// Completes the chunks up to `end` that weren't handed on yet.
    Status handOn(size_t end) {
        const auto pending = std::span(window_.chunks).subspan(handedOn_, end - handedOn_);
        setFacetedNormals(window_.chunks, pending);
        for (const Chunk& c : pending)
            if (Status status = visit_(window_, c); !status) return status;
        return Done{};
    }

    const ChunkVisitor& visit_;
    Numbering numbering_;
    Mesh window_;
    size_t handedOn_ = 0;  ///< of the window's chunks
    int z_ = -2;           ///< of the highest layer
};

}  // namespace

Result<std::vector<Chunk>> meshBlocks(std::span<const Block> blocks, const Grid& grid, const PolygonizeOptions& options,
                                      Progress* progress, Counts& counts) {
    if (progress) progress->begin("sample", blocks.size());
    return chunksOf(blocks, grid, options, progress, counts);
}

Result<Mesh> polygonize(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                        Progress* progress, Counts& counts) {
    auto chunks = meshBlocks(blocks, grid, options, progress, counts);
    if (!chunks.ok()) return chunks.error();
    Mesh mesh{std::move(*chunks)};
    const Stopwatch linking;
    if (progress) progress->begin("polygonize", 1);
    if (Status status = link(mesh.chunks, options.threads); !status) return status.error();
    tick(progress);
    counts.polygonizeSeconds += linking.seconds();
    return mesh;
}

Status polygonizeInLayers(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                          Progress* progress, Counts& counts, const ChunkVisitor& visit) {
    if (progress) progress->begin("sample", blocks.size());
    Layers layers(visit);
    for (auto first = blocks.begin(); first != blocks.end();) {
        const int z = first->index.z;
        const auto end = std::find_if(first, blocks.end(), [z](const Block& b) { return b.index.z != z; });
        auto chunks = chunksOf({first, end}, grid, options, progress, counts);
        if (!chunks.ok()) return chunks.error();
        if (Status status = layers.add(z, std::move(*chunks)); !status) return status;
        first = end;
    }
    return layers.finish();
}

}  // namespace sgm::mesh
