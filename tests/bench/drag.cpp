#include "tests/bench/drag.h"

#include <algorithm>

#include "modeler/mesh/rebuild.h"

namespace sgm::bench {
namespace {

/// Vertex by vertex and corner by corner.
bool equal(const mesh::Mesh& a, const mesh::Mesh& b) {
    return std::equal(a.chunks.begin(), a.chunks.end(), b.chunks.begin(), b.chunks.end(),
                      [](const auto& c, const auto& d) {
                          return c.block == d.block && c.firstVertex == d.firstVertex && c.positions == d.positions &&
                                 c.normals == d.normals && c.triangles == d.triangles && c.origins == d.origins &&
                                 c.borrowed.vertices == d.borrowed.vertices;
                      });
}

void keepBest(BuildSeconds& best, const BuildSeconds& now) {
    if (best.total() == 0 || now.total() < best.total()) best = now;
}

/// A model with the time it took so far.
struct Timed {
    Scene scene;
    BuildSeconds seconds;
};

Result<Timed> build(const GrammarScene& scene, Running running) {
    auto made = makeScene(scene, running);
    if (!made.ok()) return made.error();
    const BuildSeconds seconds{made->deriveSeconds, made->lowerSeconds, made->compileSeconds, 0, 0};
    return Timed{std::move(*made), seconds};
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
    mesh::Rebuild rebuild({.threads = running.threads});
    mesh::Grid grid;
    for (int step = 0; step <= steps; ++step) {
        value.n[0] = param->lo->n[0] + (param->hi->n[0] - param->lo->n[0]) * (step + 0.5) / (steps + 1);
        auto model = build(scene, running);
        if (!model.ok()) return model.error();
        const Box3f bounds = model->scene.model->field.bounds;
        grid = mesh::gridToKeep(grid, bounds, step == 0 ? mesh::cellFor(bounds, resolution) : grid.cell_m, 0.2f);

        mesh::Counts keptCounts, wholeCounts;
        const Stopwatch again(running), againWall;
        const auto kept = rebuild.update(model->scene.tape, grid, nullptr, keptCounts);
        if (!kept.ok()) return kept.error();
        BuildSeconds drag = model->seconds, full = model->seconds;
        drag.mesh = again.seconds();
        drag.descend = keptCounts.subdivideSeconds * drag.mesh / againWall.seconds();
        if (step > 0) keepBest(result.drag, drag);

        const Stopwatch whole(running), wholeWall;
        const auto blocks = mesh::subdivide(model->scene.tape, grid, running.threads, nullptr, wholeCounts);
        if (!blocks.ok()) return blocks.error();
        const auto mesh = mesh::polygonize(*blocks, grid, {.threads = running.threads}, nullptr, wholeCounts);
        if (!mesh.ok()) return mesh.error();
        full.mesh = whole.seconds();
        full.descend = wholeCounts.subdivideSeconds * full.mesh / wholeWall.seconds();
        if (step > 0) keepBest(result.full, full);
        if (!equal(**kept, *mesh)) return Error{Error::Kind::Internal, "the mesh made anew in part is another one"};
    }
    result.blocksMade = rebuild.blocksMade();
    result.blocksKept = rebuild.blocksKept();
    return result;
}

}  // namespace sgm::bench
