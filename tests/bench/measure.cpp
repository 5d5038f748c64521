#include "tests/bench/measure.h"

#include <algorithm>
#include <functional>
#include <span>

#include "modeler/mesh/polygonize.h"
#include "tests/bench/memory.h"
#include "tests/bench/operation_times.h"

namespace sgm::bench {
namespace {

constexpr double patience_s = 4;   ///< of one contestant, over all rounds
constexpr double longSeconds = 3;  ///< sweeps that would take longer are measured in part
constexpr double mostVtkCorners = 3e8;

/// `grid` grown by whole cells to a cube around the same middle: what a program takes that asks for one resolution.
mesh::Grid cubeOf(mesh::Grid grid) {
    const int n = maxComponent(grid.cells);
    for (int axis = 0; axis < 3; ++axis) {
        const int before = (n - grid.cells[axis]) / 2;
        grid.origin[axis] -= grid.cell_m * static_cast<float>(before);
        grid.cells[axis] = n;
    }
    return grid;
}

/// One run from tape to mesh, on `m`'s cube; `seconds` and `counts` keep the best.
Status runOurs(const Scene& scene, const mesh::Grid& grid, Running running, mesh::PolygonizeOptions options,
               double& best, Measurement& m, mesh::Counts& counts) {
    mesh::Counts now;
    const Stopwatch watch(running), wall;
    const auto blocks = mesh::subdivide(scene.tape, grid, running.threads, nullptr, now);
    if (!blocks.ok()) return blocks.error();
    options.threads = running.threads;
    const auto mesh = mesh::polygonize(*blocks, grid, options, nullptr, now);
    if (!mesh.ok()) return mesh.error();
    const double seconds = watch.seconds(), wallSeconds = wall.seconds();
    m.vertices = mesh->vertexCount();
    m.triangles = mesh->triangleCount();
    if (best > 0 && seconds >= best) return Done{};
    best = seconds;
    counts = now;
    // Stages are told by the wall.
    for (double* stage :
         {&counts.subdivideSeconds, &counts.sampleSeconds, &counts.polygonizeSeconds, &counts.field.seconds})
        *stage *= seconds / wallSeconds;
    return Done{};
}

/// The hand-written reference where the scene has one, else its tape.
Sampler samplerOf(const Scene& scene, std::vector<eval::Workspace>& workspaces) {
    if (scene.reference) return [&](eval::Points points, float* out, int) { evaluate(*scene.reference, points, out); };
    return [&](eval::Points points, float* out, int worker) {
        eval::evaluate(scene.tape, points, out, workspaces[static_cast<size_t>(worker)]);
    };
}

/// One of those that are measured in turns.
struct Contestant {
    std::function<Status()> run;
    double spent_s = 0;
};

/// A sweep; `best` keeps the fastest. Where the whole would be long, parts are measured.
Contestant sweeper(Sweep kind, const Sampler& sampler, const mesh::Grid& grid, Running running, DenseResult& best,
                   VtkResult* vtk) {
    return {[=, &sampler, &best]() -> Status {
        DenseResult now;
        if (best.seconds == 0 || best.scaled) now = sweepDense(kind, sampler, grid, running, true);
        if (!(now.seconds > longSeconds)) now = sweepDense(kind, sampler, grid, running, false);
        if (vtk && now.values && static_cast<double>(grid.cells.x) * grid.cells.y * grid.cells.z < mostVtkCorners) {
            const VtkResult v =
                measureVtk(now.values.get(), {grid.cells.x + 1, grid.cells.y + 1, grid.cells.z + 1}, running);
            if (vtk->seconds == 0 || v.seconds < vtk->seconds) *vtk = v;
        }
        now.values.reset();
        if (best.seconds == 0 || now.seconds < best.seconds) best = now;
        return Done{};
    }};
}

Contestant openVdb(const Scene& scene, const mesh::Grid& grid, Running running, OpenVdbResult& best) {
    return {[&scene, grid, running, &best]() -> Status {
        mesh::Counts ignored;
        const auto blocks = mesh::subdivide(scene.tape, grid, running.threads, nullptr, ignored);
        if (!blocks.ok()) return blocks.error();
        const auto now = measureOpenVdb(*blocks, scene.tape, grid, running);
        if (!now.ok()) return now.error();
        if (best.triangles == 0 || now->sampleSeconds + now->meshSeconds < best.sampleSeconds + best.meshSeconds)
            best = *now;
        return Done{};
    }};
}

Status takeTurns(std::span<Contestant> contestants, int rounds) {
    for (int r = 0; r < rounds; ++r)
        for (Contestant& c : contestants) {
            if (r > 0 && c.spent_s > patience_s) continue;
            const Stopwatch watch;
            if (Status status = c.run(); !status) return status;
            c.spent_s += watch.seconds();
        }
    return Done{};
}

/// What the clock tells of a piece of time in which nothing happens. As much passes outside of the piece.
double secondsOfNothing() {
    double least = 1;
    for (int tries = 0; tries < 10; ++tries) {
        SumOfTimes sum;
        for (int i = 0; i < 1000; ++i) {
            const AddTime nothing(&sum);
        }
        least = std::min(least, sum.seconds / static_cast<double>(sum.pieces));
    }
    return least;
}

/// What evaluating the field takes, and would take from register to register. Its share of a run is that of runs which
/// read the clock around it, by themselves: the others needn't.
Status measureField(const Scene& scene, const mesh::Grid& grid, Running running, int repeats, Measurement& m) {
    Measurement timed;
    for (int r = 0; r < repeats; ++r)
        if (Status status = runOurs(scene, grid, running, {.timeField = true}, timed.totalSeconds, timed, timed.counts);
            !status)
            return status;
    const double reading = static_cast<double>(timed.counts.field.pieces) * secondsOfNothing() / running.threads;
    m.fieldSeconds =
        m.counts.sampleSeconds * (timed.counts.field.seconds - reading) / (timed.counts.sampleSeconds - 2 * reading);
    eval::Tally tally;
    if (Status status = runOurs(scene, grid, running, {.tally = &tally}, timed.totalSeconds, timed, timed.counts);
        !status)
        return status;
    m.leastFieldSeconds = leastSeconds(tally) / running.threads;
    return Done{};
}

}  // namespace

Result<Measurement> measure(const Scene& scene, int resolution, const MeasureOptions& options) {
    const Box3f bounds = scene.model->field.bounds;
    const mesh::Grid tight = mesh::gridFor(bounds, mesh::cellFor(bounds, resolution)), cube = cubeOf(tight);
    const Running running = options.running;
    Measurement m;
    m.scene = scene.name;
    m.resolution = resolution;
    m.cells = cube.cells;
    m.tapeLength = scene.tape.size();
    m.deriveSeconds = scene.deriveSeconds;
    m.lowerSeconds = scene.lowerSeconds;
    m.compileSeconds = scene.compileSeconds;
    m.handWritten = scene.reference.has_value();

    std::vector<eval::Workspace> workspaces(static_cast<size_t>(running.threads));
    const Sampler sampler = samplerOf(scene, workspaces);
    mesh::Counts ignored;
    const PeakMemory peak;
    std::vector<Contestant> contestants{{[&] {
        const Status status = runOurs(scene, cube, running, {}, m.totalSeconds, m, m.counts);
        if (m.peakBytes == 0) m.peakBytes = peak.bytes();
        return status;
    }}};
    if (options.oneThread)
        contestants.push_back({[&] {
            return runOurs(scene, cube, {1, running.clock}, {}, m.oneThreadSeconds, m, ignored);
        }});
    if (options.dense) {
        contestants.push_back(
            sweeper(Sweep::Stored, sampler, cube, running, m.dense, options.peers ? &m.vtk : nullptr));
        contestants.push_back(sweeper(Sweep::Fused, sampler, cube, running, m.fused, nullptr));
        contestants.push_back(sweeper(Sweep::Fused, sampler, tight, running, m.tight, nullptr));
    }
    if (options.peers) contestants.push_back(openVdb(scene, cube, running, m.openvdb));
    if (Status status = takeTurns(contestants, options.repeats); !status) return status.error();
    if (options.oneThread)  // again by themselves: a sweep of gigabytes just before costs two threads more than one
        if (Status status = takeTurns(std::span(contestants).first(2), 2 * options.repeats); !status)
            return status.error();
    if (Status status = measureField(scene, cube, running, std::min(options.repeats, 5), m); !status)
        return status.error();
    return m;
}

}  // namespace sgm::bench
