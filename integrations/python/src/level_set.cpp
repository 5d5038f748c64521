// Level sets as arrays and files.
#include <pybind11/stl.h>

#include "grammar/pipeline/products.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

const volume::Dense& denseOf(LevelSet& set) {
    if (!set.dense) {
        auto made = [&] {
            const py::gil_scoped_release withoutLock;
            return volume::dense(set.volume, 1);
        }();
        // Another thread may have made them meanwhile, and arrays may show them: those stay.
        if (!set.dense) set.dense = valueOf(std::move(made));
    }
    return *set.dense;
}

/// The voxels by x, y, z; x runs fastest in memory.
py::array valuesOf(const py::object& self) {
    const volume::Dense& dense = denseOf(*self.cast<LevelSet*>());
    const auto nx = static_cast<py::ssize_t>(dense.count.x), ny = static_cast<py::ssize_t>(dense.count.y);
    const std::vector<py::ssize_t> shape{nx, ny, dense.count.z}, strides{4, 4 * nx, 4 * nx * ny};
    py::array array(py::dtype::of<float>(), shape, strides, dense.values.data(), self);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

void save(const LevelSet& set, const std::string& path, const std::map<std::string, std::string>& options,
          const py::object& progress) {
    const exporter::Exporter* const row = exporter::exporterFor(path);
    if (!row || !row->wantsVolume)
        raise(Error{Error::Kind::Usage, "a level set is written as .vdb, which '" + path + "' isn't"});
    pipeline::Stages stages;
    staged<Done>(progress, 0, stages, [&](pipeline::Context& context) {
        exporter::ExportInput input =
            pipeline::exportInput(*set.model, set.model->derivation.grammar->sources[0]->name());
        input.volume = &set.volume;
        input.options = {options.begin(), options.end()};
        input.progress = context.progress;
        return exporter::write(input, path);
    });
}

}  // namespace

void bindLevelSet(py::module_& module) {
    py::class_<LevelSet>(module, "LevelSet", "A narrow band of distances to the surface.")
        .def_property_readonly("values", &valuesOf)
        .def_property_readonly("origin",
                               [](LevelSet& set) {
                                   const Vec3f low = denseOf(set).low;
                                   return py::make_tuple(low.x, low.y, low.z);
                               })
        .def_readonly("voxel", &LevelSet::voxel_m)
        .def_property_readonly("stages", [](const LevelSet& set) { return dictOf(set.stages); })
        .def("save", &save, py::arg("path"), py::arg("options"), py::arg("progress"));
}

}  // namespace sgm::python
