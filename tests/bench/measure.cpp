#include "tests/bench/measure.h"

#include <algorithm>

#include "modeler/mesh/polygonize.h"
#include "tests/bench/memory.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {
namespace {

constexpr double quickSeconds = 1;  ///< sweeps are repeated only while all of them together took less
constexpr double longSeconds = 15;  ///< longer ones are measured in part

/// One run from tape to mesh; sets `out` where it is the fastest so far.
Status runOurs(const Scene& scene, const mesh::Grid& grid, int threads, Measurement& out) {
    mesh::Counts counts;
    const Stopwatch watch;
    const auto blocks = mesh::subdivide(scene.tape, grid, threads, nullptr, counts);
    if (!blocks.ok()) return blocks.error();
    const auto mesh = mesh::polygonize(*blocks, grid, {.threads = threads}, nullptr, counts);
    if (!mesh.ok()) return mesh.error();
    const double seconds = watch.seconds();
    if (out.totalSeconds > 0 && seconds >= out.totalSeconds) return Done{};
    out.totalSeconds = seconds;
    out.counts = counts;
    out.vertices = mesh->vertexCount();
    out.triangles = mesh->triangleCount();
    return Done{};
}

/// The sweep of the whole grid, or of `maxSlabs` slabs; where that would be long, of one slab a thread, scaled up.
/// Quick ones are repeated, and the best counts.
DenseResult bestDense(const Sampler& sampler, const mesh::Grid& grid, const MeasureOptions& options) {
    DenseResult best =
        sweepDense(sampler, grid, options.threads, options.denseSlabs > 0 ? options.denseSlabs : options.threads);
    if (options.denseSlabs > 0 || best.seconds > longSeconds) return best;
    best = sweepDense(sampler, grid, options.threads, 0);
    double spent = best.seconds;
    for (int r = 1; r < options.repeats && spent < quickSeconds; ++r) {
        const DenseResult again = sweepDense(sampler, grid, options.threads, 0);
        spent += again.seconds;
        if (again.seconds < best.seconds) best = again;
    }
    return best;
}

/// The hand-written reference where the scene has one, else its tape.
Sampler samplerOf(const Scene& scene, std::vector<eval::Workspace>& workspaces) {
    if (scene.reference) return [&](eval::Points points, float* out, int) { evaluate(*scene.reference, points, out); };
    return [&](eval::Points points, float* out, int worker) {
        eval::evaluate(scene.tape, points, out, workspaces[static_cast<size_t>(worker)]);
    };
}

}  // namespace

Result<Measurement> measure(const Scene& scene, int resolution, const MeasureOptions& options) {
    const Box3f bounds = scene.model->field.bounds;
    const mesh::Grid grid = mesh::gridFor(bounds, mesh::cellFor(bounds, resolution));
    Measurement m;
    m.scene = scene.name;
    m.resolution = resolution;
    m.tapeLength = scene.tape.size();
    m.deriveSeconds = scene.deriveSeconds;
    m.lowerSeconds = scene.lowerSeconds;
    m.compileSeconds = scene.compileSeconds;
    const PeakMemory peak;
    for (int r = 0; r < options.repeats; ++r) {
        if (Status status = runOurs(scene, grid, options.threads, m); !status) return status.error();
        if (r == 0) m.peakBytes = peak.bytes();
    }
    std::vector<eval::Workspace> workspaces(static_cast<size_t>(options.threads));
    m.dense = bestDense(samplerOf(scene, workspaces), grid, options);
    m.handWritten = scene.reference.has_value();
    if (options.peers) {
        mesh::Counts ignored;
        const auto blocks = mesh::subdivide(scene.tape, grid, options.threads, nullptr, ignored);
        if (!blocks.ok()) return blocks.error();
        const auto openvdb = measureOpenVdb(*blocks, scene.tape, grid, options.threads);
        if (!openvdb.ok()) return openvdb.error();
        m.openvdb = *openvdb;
    }
    return m;
}

}  // namespace sgm::bench
