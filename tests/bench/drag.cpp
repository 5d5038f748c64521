#include "tests/bench/drag.h"

#include <algorithm>

#include "grammar/pipeline/incremental.h"

namespace sgm::bench {
namespace {

/// Vertex by vertex and corner by corner.
bool equal(const mesh::Mesh& a, const mesh::Mesh& b) {
    return std::equal(a.chunks.begin(), a.chunks.end(), b.chunks.begin(), b.chunks.end(),
                      [](const auto& c, const auto& d) {
                          return c.block == d.block && c.firstVertex == d.firstVertex && c.positions == d.positions &&
                                 c.normals == d.normals && c.triangles == d.triangles && c.origins == d.origins &&
                                 c.ghosts.vertices == d.ghosts.vertices;
                      });
}

void keepBest(BuildSeconds& best, const BuildSeconds& now) {
    if (best.total() == 0 || now.total() < best.total()) best = now;
}

/// From the grammar to the mesh with what was kept.
Result<const mesh::Mesh*> follow(pipeline::IncrementalPipeline& pipeline, const GrammarScene& scene, mesh::Grid& grid,
                                 int resolution, Running running, BuildSeconds& seconds) {
    const Stopwatch deriving(running);
    if (const Status done = pipeline.derive(scene.grammar, scene.options, nullptr); !done) return done.error();
    seconds.derive = deriving.seconds();
    const Stopwatch lowering(running);
    if (const Status done = pipeline.lower(nullptr); !done) return done.error();
    seconds.lower = lowering.seconds();
    const Stopwatch compiling(running);
    pipeline.compile();
    seconds.compile = compiling.seconds();
    const Box3f bounds = pipeline.model().field.bounds;
    grid = mesh::gridToKeep(grid, bounds, grid.cells.x == 0 ? mesh::cellFor(bounds, resolution) : grid.cell_m, 0.2f);
    mesh::Counts counts;
    const Stopwatch meshing(running), wall;
    const auto mesh = pipeline.mesh(grid, nullptr, counts);
    seconds.mesh = meshing.seconds();
    seconds.descend = counts.subdivideSeconds * seconds.mesh / wall.seconds();
    return mesh;
}

/// From the grammar to the mesh, from the start.
Result<mesh::Mesh> build(const GrammarScene& scene, const mesh::Grid& grid, Running running, BuildSeconds& seconds) {
    const auto made = makeScene(scene, running);
    if (!made.ok()) return made.error();
    mesh::Counts counts;
    const Stopwatch meshing(running), wall;
    const auto blocks = mesh::subdivide(made->tape, grid, running.threads, nullptr, counts);
    if (!blocks.ok()) return blocks.error();
    auto mesh = mesh::polygonize(*blocks, grid, {.threads = running.threads}, nullptr, counts);
    seconds = {made->deriveSeconds, made->lowerSeconds, made->compileSeconds, meshing.seconds(), 0};
    seconds.descend = counts.subdivideSeconds * seconds.mesh / wall.seconds();
    return mesh;
}

}  // namespace

Result<DragResult> measureDrag(const GrammarScene& start, const std::string& parameter, int resolution, int steps,
                               Running running) {
    const auto& params = start.grammar->params;
    const auto param = std::find_if(params.begin(), params.end(), [&](const auto& p) { return p.name == parameter; });
    if (param == params.end() || !param->lo)
        return Error{Error::Kind::Input, "no parameter with a range is called " + parameter};
    GrammarScene scene = start;
    rules::Value& value = scene.options.params[static_cast<size_t>(param - params.begin())];
    DragResult result{scene.name, parameter, resolution, {}, {}, 0, 0};
    pipeline::IncrementalPipeline pipeline({.threads = running.threads});
    mesh::Grid grid;
    for (int step = 0; step <= steps; ++step) {
        value.n[0] = param->lo->n[0] + (param->hi->n[0] - param->lo->n[0]) * (step + 0.5) / (steps + 1);
        BuildSeconds drag, full;
        const auto kept = follow(pipeline, scene, grid, resolution, running, drag);
        if (!kept.ok()) return kept.error();
        const auto mesh = build(scene, grid, running, full);
        if (!mesh.ok()) return mesh.error();
        if (!equal(**kept, *mesh)) return Error{Error::Kind::Internal, "the mesh made anew in part is another one"};
        if (step == 0) continue;
        keepBest(result.drag, drag);
        keepBest(result.full, full);
    }
    result.blocksMade = pipeline.rebuild().blocksMade();
    result.blocksKept = pipeline.rebuild().blocksKept();
    return result;
}

}  // namespace sgm::bench
