#include "modeler/mesh/polygonize.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <string>

#include "modeler/core/parallel.h"
#include "modeler/mesh/triangles.h"
#include "modeler/mesh/vertices.h"

namespace sgm::mesh {
namespace {

/// Seconds since construction.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What one worker reuses from block to block.
struct Scratch {
    eval::Workspace workspace;
    BlockSamples samples;
    EdgeLanes lanes;
    BlockVertices vertices;
    BrickVertices joined;
    Counts counts;
    eval::Tally tally;
};

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

/// First pass: samples a block, finds its vertices and how many triangles will join them. False when cancelled.
bool findVertices(const Block& block, const Grid& grid, const PolygonizeOptions& options, const Progress* progress,
                  Scratch& s, BlockSurface& surface, Chunk& chunk) {
    surface.index = chunk.block = block.index;
    if (!sampleBlock(block, grid, s.workspace, progress, s.samples, s.counts)) return false;
    s.vertices.clear();
    const auto owners = block.tape.origins();
    const bool wantOrigins = std::any_of(owners.begin(), owners.end(), [](OriginId id) { return id != 0; });
    for (uint64_t rest = s.samples.active; rest != 0; rest &= rest - 1) {
        if (cancelled(progress)) return false;
        Brick brick = makeBrick(std::countr_zero(rest), block.index, grid, s.samples);
        if (brick.cells == 0) continue;
        brick.firstVertex = static_cast<uint32_t>(s.vertices.positions.size());
        surface.triangles += brick.triangles;
        s.counts.surfaceCells += brick.cells;
        appendVertices(brick, block.index, grid, s.samples, options.refineSteps, wantOrigins, s.workspace, s.lanes,
                       s.vertices, s.counts);
        surface.bricks.push_back(brick);
        surface.brickOf[brick.number] = static_cast<uint8_t>(surface.bricks.size());
    }
    surface.vertices = static_cast<uint32_t>(s.vertices.positions.size());
    surface.vertexOrigins.assign(s.vertices.origins.begin(), s.vertices.origins.end());
    chunk.positions.assign(s.vertices.positions.begin(), s.vertices.positions.end());
    chunk.normals.assign(s.vertices.normals.begin(), s.vertices.normals.end());
    return true;
}

uint64_t bytesOf(const BlockSurface& surface) {
    return surface.bricks.capacity() * sizeof(Brick) + surface.vertexOrigins.size() * sizeof(OriginId) +
           surface.vertices * 2ull * sizeof(Vec3f) + surface.triangles * (sizeof(Triangle) + sizeof(OriginId));
}

/// Gives vertices where the field had no usable derivative the mean of their triangles' normals, weighted by area.
void fillMissingNormals(Mesh& mesh) {
    std::vector<uint32_t> missing;  // global numbers, ascending
    for (const Chunk& c : mesh.chunks)
        for (size_t i = 0; i < c.normals.size(); ++i)
            if (c.normals[i] == Vec3f{}) missing.push_back(c.firstVertex + static_cast<uint32_t>(i));
    if (missing.empty()) return;

    const auto chunkOf = [&](uint32_t vertex) -> Chunk& {
        return *std::prev(std::upper_bound(mesh.chunks.begin(), mesh.chunks.end(), vertex,
                                           [](uint32_t v, const Chunk& c) { return v < c.firstVertex; }));
    };
    const auto position = [&](uint32_t v) {
        const Chunk& c = chunkOf(v);
        return c.positions[v - c.firstVertex].as<double>();
    };
    std::vector<Vec3d> sums(missing.size());
    for (const Chunk& c : mesh.chunks)
        for (const Triangle& t : c.triangles)
            for (int corner = 0; corner < 3; ++corner) {
                const auto at = std::lower_bound(missing.begin(), missing.end(), t[corner]);
                if (at == missing.end() || *at != t[corner]) continue;
                const Vec3d p = position(t.x);
                sums[static_cast<size_t>(at - missing.begin())] += cross(position(t.y) - p, position(t.z) - p);
            }
    for (size_t i = 0; i < missing.size(); ++i) {
        const Vec3d n = normalized(sums[i]);
        Chunk& c = chunkOf(missing[i]);
        c.normals[missing[i] - c.firstVertex] = n == Vec3d{} ? Vec3f{0, 1, 0} : n.as<float>();
    }
}

}  // namespace

Result<Mesh> polygonize(const std::vector<Block>& blocks, const Grid& grid, const PolygonizeOptions& options,
                        Progress* progress, Counts& counts) {
    if (Status status = checkGrid(grid); !status) return status.error();
    const Stopwatch sampling;
    Memory memory(options.memoryBudget_bytes);
    Mesh mesh;
    mesh.chunks.resize(blocks.size());
    std::vector<BlockSurface> surfaces(blocks.size());
    std::vector<Scratch> scratch(static_cast<size_t>(threadCount(options.threads)));
    for (Scratch& s : scratch) s.workspace.tallyInto(options.tally ? &s.tally : nullptr);

    if (progress) progress->begin("sample", blocks.size());
    parallelFor(blocks.size(), options.threads, progress, [&](size_t b, int worker) {
        if (memory.exceeded()) return;
        if (!findVertices(blocks[b], grid, options, progress, scratch[worker], surfaces[b], mesh.chunks[b])) return;
        memory.add(bytesOf(surfaces[b]));
        tick(progress);
    });
    if (cancelled(progress)) return cancelledError();
    if (memory.exceeded()) return memory.error();
    uint64_t vertices = 0, triangles = 0;
    for (size_t b = 0; b < blocks.size(); ++b) {
        surfaces[b].firstVertex = mesh.chunks[b].firstVertex = static_cast<uint32_t>(vertices);
        vertices += surfaces[b].vertices;
        triangles += surfaces[b].triangles;
    }
    if (std::max(vertices, triangles) >= std::numeric_limits<uint32_t>::max())
        return Error{Error::Kind::Budget, "the mesh has more than 2^32 vertices or triangles: choose larger cells"};
    for (const Scratch& s : scratch) {
        counts += s.counts;
        for (const auto& [operation, points] : s.tally) (*options.tally)[operation] += points;
    }
    counts.sampleSeconds += sampling.seconds();

    const Stopwatch joining;
    if (progress) progress->begin("polygonize", blocks.size());
    parallelFor(blocks.size(), options.threads, progress, [&](size_t b, int worker) {
        BrickVertices& joined = scratch[worker].joined;
        joinVertices(surfaces[b], surfaces, joined);
        mesh.chunks[b].triangles.assign(joined.triangles.begin(), joined.triangles.end());
        mesh.chunks[b].origins.assign(joined.origins.begin(), joined.origins.end());
        tick(progress);
    });
    if (cancelled(progress)) return cancelledError();
    std::erase_if(mesh.chunks, [](const Chunk& c) { return c.positions.empty() && c.triangles.empty(); });
    fillMissingNormals(mesh);
    counts.polygonizeSeconds += joining.seconds();
    return mesh;
}

}  // namespace sgm::mesh
