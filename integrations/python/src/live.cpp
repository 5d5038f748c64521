// Models that follow their parameters, every stage keeping what a change doesn't reach.
#include <pybind11/stl.h>

#include "grammar/pipeline/grids.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

Live liveOf(const Grammar& grammar, const MeshRequest& request, int threads) {
    mesh::PolygonizeOptions meshing{.surface = request.surface, .threads = threads};
    return {grammar.rules, request, threads, {}, std::make_unique<pipeline::IncrementalPipeline>(meshing)};
}

Result<std::shared_ptr<Mesh>> follow(Live& live, const derive::Options& options, pipeline::Context& context) {
    pipeline::IncrementalPipeline& stages = *live.pipeline;
    if (const Status done = stages.to(live.rules, options, context); !done.ok()) return done.error();
    const Box3f& bounds = stages.model().field.bounds;
    float cell_m = static_cast<float>(live.request.cell_m);
    if (cell_m <= 0) cell_m = live.grid.cells.x > 0 ? live.grid.cell_m : mesh::cellFor(bounds, live.request.resolution);
    live.grid = pipeline::gridToKeep(live.grid, bounds, cell_m, stages.derivation(), live.request.surface);
    auto meshed = stages.meshed(live.grid, context);
    if (!meshed.ok()) return meshed.error();
    auto model = context.timed("copy", [&] { return std::make_shared<pipeline::Model>(stages.copyModel()); });
    return finish(std::move(model), std::move(*meshed), live.request, context);
}

/// Keeps a model from being changed by two threads of Python at once, or by its own progress callback.
class InUse {
public:
    explicit InUse(Live& live) : live_(live) {
        if (live.isInUse)
            raise(
                Error{Error::Kind::Usage, "this live model is being meshed already: make another one for each thread"});
        live.isInUse = true;
    }
    ~InUse() { live_.isInUse = false; }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

private:
    Live& live_;
};

std::shared_ptr<Mesh> meshOf(Live& live, const Choice& choice, const py::object& progress) {
    const InUse thisCall(live);
    const derive::Options options = choice.optionsFor(*live.rules);
    pipeline::Stages stages;
    auto made = staged<std::shared_ptr<Mesh>>(progress, live.threads, stages,
                                              [&](auto& context) { return follow(live, options, context); });
    made->stages = std::move(stages);
    return made;
}

}  // namespace

void bindLive(py::module_& module) {
    py::class_<Live>(module, "Live", "A model whose parameters change.")
        .def(py::init(&liveOf), py::arg("grammar"), py::arg("request"), py::arg("threads"))
        .def("mesh", &meshOf, py::arg("choice"), py::arg("progress"))
        .def_property_readonly("followed", [](const Live& live) { return live.pipeline->followed(); })
        .def_property_readonly("blocks_made", [](const Live& live) { return live.pipeline->rebuild().blocksMade(); })
        .def_property_readonly("blocks_kept", [](const Live& live) { return live.pipeline->rebuild().blocksKept(); });
}

}  // namespace sgm::python
