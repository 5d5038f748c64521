// Models: the field at points, meshes and level sets of it.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>

#include "grammar/pipeline/grids.h"
#include "grammar/rules/grammar.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"
#include "modeler/core/parallel.h"
#include "modeler/core/stopwatch.h"
#include "modeler/eval/evaluate.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

/// Points that one thread takes at a time: their rows stay in its first cache.
constexpr size_t batch = 1024;

struct alignas(64) Rows {
    std::array<float, batch> x, y, z, value, dx, dy, dz;
    std::array<OriginId, batch> origin;
};

/// Positions (x, y, z, x, y, z …) as rows, up to `batch` of them.
void transpose(const float* from, size_t n, Rows& rows) {
    for (size_t i = 0; i < n; ++i) {
        rows.x[i] = from[3 * i];
        rows.y[i] = from[3 * i + 1];
        rows.z[i] = from[3 * i + 2];
    }
    const size_t padded = std::min(batch, (n + eval::pointPadding - 1) / eval::pointPadding * eval::pointPadding);
    for (size_t i = n; i < padded; ++i) rows.x[i] = rows.y[i] = rows.z[i] = 0;
}

/// Calls body(first, n, rows, workspace) for all points, a batch at a time, in parallel, with rows.x, y and z filled.
/// Without Python's lock.
template <class Body>
void forBatches(const Points& points, int threads, Body body) {
    const size_t count = static_cast<size_t>(points.size()) / 3;
    const float* const from = points.data();
    const py::gil_scoped_release withoutLock;
    const auto workers = static_cast<size_t>(threadCount(threads));
    std::vector<eval::Workspace> scratch(workers);
    std::vector<Rows> rows(workers);
    parallelFor((count + batch - 1) / batch, threads, nullptr, [&](size_t b, int worker) {
        const auto w = static_cast<size_t>(worker);
        const size_t first = b * batch, n = std::min(batch, count - first);
        transpose(from + 3 * first, n, rows[w]);
        body(first, n, rows[w], scratch[w]);
    });
}

eval::Points pointsOf(const Rows& rows, size_t n) { return {rows.x.data(), rows.y.data(), rows.z.data(), n, true}; }

/// The shape of points without its last axis, which is that of coordinates; ValueError for another one.
std::vector<py::ssize_t> shapeOf(const Points& points) {
    if (points.ndim() == 0 || points.shape(points.ndim() - 1) != 3)
        throw py::value_error("points are an array whose last axis holds x, y and z: its shape is (…, 3)");
    return {points.shape(), points.shape() + points.ndim() - 1};
}

py::array_t<float> values(const Model& model, const Points& points) {
    py::array_t<float> out(shapeOf(points));
    float* const to = out.mutable_data();
    forBatches(points, model.threads, [&](size_t first, size_t n, Rows& rows, eval::Workspace& workspace) {
        eval::evaluate(model.made->tape, pointsOf(rows, n), rows.value.data(), workspace);
        std::copy_n(rows.value.data(), n, to + first);
    });
    return out;
}

py::tuple gradients(const Model& model, const Points& points) {
    py::array_t<float> value(shapeOf(points));
    py::array_t<float> slope(std::vector<py::ssize_t>(points.shape(), points.shape() + points.ndim()));
    float *const toValue = value.mutable_data(), *const toSlope = slope.mutable_data();
    forBatches(points, model.threads, [&](size_t first, size_t n, Rows& rows, eval::Workspace& workspace) {
        eval::evaluateGradient(model.made->tape, pointsOf(rows, n), rows.value.data(), rows.dx.data(), rows.dy.data(),
                               rows.dz.data(), workspace);
        std::copy_n(rows.value.data(), n, toValue + first);
        for (size_t i = 0; i < n; ++i) {
            float* const g = toSlope + 3 * (first + i);
            g[0] = rows.dx[i], g[1] = rows.dy[i], g[2] = rows.dz[i];
        }
    });
    return py::make_tuple(value, slope);
}

py::array_t<uint32_t> origins(const Model& model, const Points& points) {
    py::array_t<uint32_t> out(shapeOf(points));
    uint32_t* const to = out.mutable_data();
    forBatches(points, model.threads, [&](size_t first, size_t n, Rows& rows, eval::Workspace& workspace) {
        eval::evaluateOrigin(model.made->tape, pointsOf(rows, n), rows.origin.data(), workspace);
        std::copy_n(rows.origin.data(), n, to + first);
    });
    return out;
}

/// What the library itself takes for the values at these points, which lie in rows already: the measure of `values`.
double evaluationSeconds(const Model& model, const Points& points) {
    const size_t count = static_cast<size_t>(points.size()) / 3;
    PageVector<float> x(count + batch), y(count + batch), z(count + batch), out(count + batch);
    for (size_t i = 0; i < count; ++i)
        x[i] = points.data()[3 * i], y[i] = points.data()[3 * i + 1], z[i] = points.data()[3 * i + 2];
    const py::gil_scoped_release withoutLock;
    std::vector<eval::Workspace> scratch(static_cast<size_t>(threadCount(model.threads)));
    const Stopwatch watch;
    parallelFor((count + batch - 1) / batch, model.threads, nullptr, [&](size_t b, int worker) {
        const size_t first = b * batch, n = std::min(batch, count - first);
        eval::evaluate(model.made->tape, {&x[first], &y[first], &z[first], n, true}, &out[first],
                       scratch[static_cast<size_t>(worker)]);
    });
    return watch.seconds();
}

mesh::Grid gridOf(const Model& model, const MeshRequest& request) {
    return pipeline::gridOver(*model.made, {request.resolution, request.cell_m}, request.surface);
}

std::shared_ptr<Mesh> meshOf(const Model& model, const MeshRequest& request, const py::object& progress) {
    pipeline::Stages stages;
    auto made = staged<std::shared_ptr<Mesh>>(
        progress, model.threads, stages, [&](pipeline::Context& context) -> Result<std::shared_ptr<Mesh>> {
            auto meshed =
                pipeline::makeMesh(*model.made, gridOf(model, request), {.surface = request.surface}, context);
            if (!meshed.ok()) return meshed.error();
            return finish(model.made, std::move(*meshed), request, context);
        });
    made->stages = std::move(stages);
    return made;
}

LevelSet levelSetOf(const Model& model, int resolution, std::optional<double> cell_m, int halfWidth,
                    const py::object& progress) {
    const MeshRequest request = requestOf(resolution, cell_m, "crisp", "all", 0, 1, {});
    pipeline::Stages stages;
    const mesh::Grid grid = gridOf(model, request);
    auto volume = staged<volume::Volume>(
        progress, model.threads, stages, [&](pipeline::Context& context) -> Result<volume::Volume> {
            mesh::Counts counts;
            auto blocks = context.timed("subdivide", [&] {
                return mesh::subdivide(model.made->tape, grid, context.threads, context.progress, counts);
            });
            if (!blocks.ok()) return blocks.error();
            return context.timed("level set", [&] {
                return volume::sample(*blocks, model.made->tape, grid, halfWidth, context.threads, context.progress);
            });
        });
    return {model.made, std::move(volume), grid.cell_m, {}, std::move(stages)};
}

py::dict parametersOf(const Model& model) {
    py::dict texts;
    const auto& params = model.made->derivation.grammar->params;
    for (size_t i = 0; i < params.size(); ++i)
        texts[py::str(params[i].name)] = rules::toText(model.made->derivation.params[i]);
    return texts;
}

}  // namespace

py::dict dictOf(const pipeline::Stages& stages) {
    py::dict seconds;
    for (const auto& [name, time] : stages) seconds[py::str(name)] = time;
    return seconds;
}

py::tuple tupleOf(const Box3f& box) {
    return py::make_tuple(py::make_tuple(box.lo.x, box.lo.y, box.lo.z), py::make_tuple(box.hi.x, box.hi.y, box.hi.z));
}

void bindModel(py::module_& module) {
    py::class_<Model>(module, "Model", "A field made by a grammar, ready to be evaluated and meshed.")
        .def("values", &values, py::arg("points"), "The field at points of shape (…, 3): metres, negative inside.")
        .def("gradients", &gradients, py::arg("points"), "The field and its derivatives at points of shape (…, 3).")
        .def("origins", &origins, py::arg("points"), "For each point the part whose surface is nearest by the field.")
        .def("mesh", &meshOf, py::arg("request"), py::arg("progress"))
        .def("scene", &sceneOf, py::arg("request"), py::arg("max_places"), py::arg("progress"))
        .def("level_set", &levelSetOf, py::arg("resolution"), py::arg("cell"), py::arg("half_width"),
             py::arg("progress"))
        .def("_evaluation_seconds", &evaluationSeconds, py::arg("points"))
        .def_property_readonly("bounds", [](const Model& m) { return tupleOf(m.made->lowered->field.bounds); })
        .def_property_readonly("seed", [](const Model& m) { return m.made->derivation.seed; })
        .def_property_readonly("parameters", &parametersOf)
        .def_property_readonly("warnings",
                               [](const Model& m) { return syntax::toJson(derive::warnings(m.made->derivation)); })
        .def_property_readonly("shapes", [](const Model& m) { return m.made->derivation.tree.shapes.size(); })
        .def_property_readonly("bonds", [](const Model& m) { return m.made->derivation.tree.bonds().all.size(); })
        .def_property_readonly("instructions", [](const Model& m) { return m.made->tape.size(); })
        .def_property_readonly("lipschitz", [](const Model& m) { return m.made->tape.lipschitz(); })
        .def_property_readonly("stages", [](const Model& m) { return dictOf(m.stages); });
}

}  // namespace sgm::python
