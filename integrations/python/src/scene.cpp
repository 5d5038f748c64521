// Scenes: the objects that `place` puts, each once, and where they stand.
#include "grammar/pipeline/scene.h"

#include <pybind11/stl.h>

#include "grammar/pipeline/products.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

/// The mesh of an object, which keeps the whole scene's list of materials.
std::shared_ptr<Mesh> meshOf(const mesh::SceneObject& object, const MeshRequest& request, int threads) {
    auto made = std::make_shared<Mesh>();
    made->provenance = std::make_shared<const Provenance>(object.provenance);
    made->name = object.name;
    made->chunks = object.mesh;
    made->grid.cell_m = static_cast<float>(request.cell_m);
    made->meshing.surface = request.surface;
    made->edits = request.edits;
    made->threads = threads;
    made->flatten();
    return made;
}

void fill(Scene& scene, const MeshRequest& request) {
    for (const mesh::SceneObject& object : scene.made.scene.objects)
        scene.meshes.push_back(meshOf(object, request, scene.threads));
    for (const mesh::Instance& instance : scene.made.scene.instances) {
        scene.objectOf.push_back(instance.object);
        const Pose& pose = instance.part.pose;
        for (int row = 0; row < 3; ++row)
            for (const double number : {pose.axes.x[row], pose.axes.y[row], pose.axes.z[row], pose.origin[row]})
                scene.matrices.push_back(number);
        scene.matrices.insert(scene.matrices.end(), {0, 0, 0, 1});
    }
}

template <class Number>
py::array viewOf(const std::vector<Number>& numbers, std::vector<py::ssize_t> shape, const py::handle& owner) {
    py::array array(py::dtype::of<Number>(), std::move(shape), numbers.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array objectOf(const py::object& self) {
    const auto& scene = self.cast<const Scene&>();
    return viewOf(scene.objectOf, {static_cast<py::ssize_t>(scene.objectOf.size())}, self);
}

py::array matricesOf(const py::object& self) {
    const auto& scene = self.cast<const Scene&>();
    return viewOf(scene.matrices, {static_cast<py::ssize_t>(scene.objectOf.size()), 4, 4}, self);
}

py::list objectsOf(const Scene& scene) {
    py::list objects;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const mesh::SceneObject& object = scene.made.scene.objects[i];
        objects.append(py::make_tuple(object.name, object.values, scene.meshes[i]));
    }
    return objects;
}

py::list placesOf(const Scene& scene) {
    py::list places;
    for (const mesh::Instance& instance : scene.made.scene.instances)
        places.append(py::make_tuple(instance.part.path.text(), instance.part.rule(), instance.part.file(),
                                     instance.part.line()));
    return places;
}

void save(const Scene& scene, const std::string& path, const std::shared_ptr<Mesh>& ground,
          const std::map<std::string, std::string>& options, const py::object& progress) {
    const exporter::Exporter* const row = exporter::exporterFor(path);
    if (!row || !row->wantsMesh())
        raise(Error{Error::Kind::Usage, "'" + path + "' isn't of a format that holds meshes"});
    if (ground && ground->model != scene.model)
        raise(Error{Error::Kind::Usage, "the ground is the mesh of another model"});
    pipeline::Stages stages;
    staged<Done>(progress, scene.threads, stages, [&](pipeline::Context& context) -> Status {
        const mesh::Mesh none;
        exporter::ExportInput input =
            pipeline::exportInput(*scene.model, scene.model->derivation.grammar->sources[0]->name());
        input.mesh = ground ? &ground->chunks : &none;
        input.scene = &scene.made.scene;
        input.provenance = &scene.made.scene.ground;
        input.options = {options.begin(), options.end()};
        input.progress = context.progress;
        return exporter::write(input, path);
    });
}

}  // namespace

Scene sceneOf(const Model& model, const MeshRequest& request, uint64_t most, const py::object& progress) {
    if (!model.apart)
        raise(Error{Error::Kind::Usage, "the objects of this model are part of its field: make it with apart=True"});
    Scene scene;
    scene.model = model.made;
    scene.threads = model.threads;
    pipeline::SceneRequest wanted{request.resolution, request.cell_m, {.surface = request.surface}, request.edits, {}};
    wanted.budget.shapes = most;
    scene.made = staged<pipeline::MadeScene>(progress, model.threads, scene.stages, [&](pipeline::Context& context) {
        return pipeline::makeScene(*model.made, wanted, context);
    });
    fill(scene, request);
    return scene;
}

void bindScene(py::module_& module) {
    py::class_<Scene>(module, "Scene", "The objects that `place` puts into a model, and their places.")
        .def_property_readonly("objects", &objectsOf)
        .def_property_readonly("object_of", &objectOf)
        .def_property_readonly("matrices", &matricesOf)
        .def_property_readonly("places", &placesOf)
        .def_property_readonly("warnings", [](const Scene& s) { return syntax::toJson(s.made.warnings); })
        .def_property_readonly("stages", [](const Scene& s) { return dictOf(s.stages); })
        .def("save", &save, py::arg("path"), py::arg("ground").none(true), py::arg("options"), py::arg("progress"));
}

}  // namespace sgm::python
