#include "modeler/mesh/polygonize.h"

#include <algorithm>
#include <atomic>
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
    return sizeof(Chunk) + c.positions.size() * 2 * sizeof(Vec3f) +
           c.triangles.size() * (sizeof(Triangle) + sizeof(OriginId)) +
           (c.borrowed.vertices.size() + c.lent.vertices.size()) * sizeof(uint32_t);
}

}  // namespace

Result<std::vector<Chunk>> meshBlocks(const std::vector<Block>& blocks, const Grid& grid,
                                      const PolygonizeOptions& options, Progress* progress, Counts& counts) {
    if (Status status = checkGrid(grid); !status) return status.error();
    Memory memory(options.memoryBudget_bytes);
    const auto threads = static_cast<size_t>(threadCount(options.threads));
    std::vector<BlockMesher> workers;
    std::vector<eval::Tally> tallies(threads);
    for (size_t w = 0; w < threads; ++w) {
        workers.emplace_back(grid, static_cast<size_t>(options.refineSteps));
        if (options.tally) workers[w].tallyInto(&tallies[w]);
    }
    std::vector<Chunk> chunks(blocks.size());

    if (progress) progress->begin("sample", blocks.size());
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
    counts += counted;
    for (const eval::Tally& tally : tallies)
        for (const auto& [operation, points] : tally) (*options.tally)[operation] += points;
    std::erase_if(chunks, [](const Chunk& c) { return c.triangles.empty(); });
    return chunks;
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

}  // namespace sgm::mesh
