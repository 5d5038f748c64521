#include "modeler/export/gltf_instances.h"

#include <array>
#include <cmath>
#include <cstring>

#include "modeler/core/distinct_names.h"
#include "modeler/export/formats.h"
#include "modeler/export/gltf_nodes.h"

namespace sgm::exporter {
namespace {

using Value = tinygltf::Value;

Value textOf(const std::string& text) { return Value(validUtf8(text)); }

/// What decides an object, as its node says it.
Value::Object valuesOf(const mesh::SceneObject& object) {
    Value::Object extras;
    for (const auto& [name, value] : object.values) extras[validUtf8(name)] = textOf(value);
    return extras;
}

/// A mesh for every object.
Status addMeshes(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf,
                 std::vector<int>& meshOf) {
    for (const mesh::SceneObject& object : input.scene->objects) {
        ExportInput own = input;
        own.mesh = &object.mesh;
        own.provenance = &object.provenance;
        own.objects = nullptr;
        own.colliders = {};
        own.levels = {};
        own.scene = nullptr;
        own.name = object.name;
        const auto made = modelOf(own);
        if (!made.ok()) return made.error();
        meshOf.push_back(appendMesh(model, *made));
        model.meshes.back().extras = originTable(object.provenance, object.mesh);
    }
    return Done{};
}

void addPlaces(tinygltf::Model& model, const mesh::Scene& scene, const std::vector<int>& meshOf) {
    DistinctNames names;
    for (const tinygltf::Node& node : model.nodes) names.take(node.name);
    for (const mesh::Instance& instance : scene.instances) {
        const mesh::SceneObject& object = scene.objects[instance.object];
        const Pose& pose = instance.part.pose;
        tinygltf::Node node;
        node.name = names.take(validUtf8(object.name));
        node.mesh = meshOf[instance.object];
        node.translation = {pose.origin.x, pose.origin.y, pose.origin.z};
        if (pose.axes != Mat3{}) {
            const auto q = mesh::quaternionOf(pose.axes);
            node.rotation = {q[0], q[1], q[2], q[3]};
        }
        Value::Object extras = valuesOf(object);
        extras["path"] = textOf(instance.part.path.text());
        if (!instance.part.rule().empty()) extras["rule"] = textOf(instance.part.rule());
        extras["file"] = textOf(instance.part.file());
        extras["line"] = Value(static_cast<int>(instance.part.line()));
        node.extras = Value(extras);
        addToRoot(model, std::move(node));
    }
}

/// Appends numbers to the buffer with an accessor over them; its index.
template <size_t N>
int addNumbers(tinygltf::Model& model, const std::vector<std::array<float, N>>& numbers) {
    auto& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = numbers.size() * sizeof numbers[0];
    data.resize(data.size() + view.byteLength);
    std::memcpy(data.data() + view.byteOffset, numbers.data(), view.byteLength);
    model.bufferViews.push_back(std::move(view));
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = N == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC4;
    accessor.count = numbers.size();
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size()) - 1;
}

void addGpuPlaces(tinygltf::Model& model, const mesh::Scene& scene, const std::vector<int>& meshOf) {
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        std::vector<std::array<float, 3>> translations;
        std::vector<std::array<float, 4>> rotations;
        for (const mesh::Instance& instance : scene.instances) {
            if (instance.object != i) continue;
            const Vec3f at = instance.part.pose.origin.as<float>();
            const auto q = mesh::quaternionOf(instance.part.pose.axes);
            translations.push_back({at.x, at.y, at.z});
            rotations.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                                 static_cast<float>(q[3])});
        }
        if (translations.empty()) continue;
        Value::Object attributes;
        attributes["TRANSLATION"] = Value(addNumbers(model, translations));
        attributes["ROTATION"] = Value(addNumbers(model, rotations));
        tinygltf::Node node;
        node.name = validUtf8(scene.objects[i].name);
        node.mesh = meshOf[i];
        node.extras = Value(valuesOf(scene.objects[i]));
        node.extensions["EXT_mesh_gpu_instancing"] = Value(Value::Object{{"attributes", Value(attributes)}});
        addToRoot(model, std::move(node));
    }
    model.extensionsUsed.emplace_back("EXT_mesh_gpu_instancing");
    model.extensionsRequired.emplace_back("EXT_mesh_gpu_instancing");
}

}  // namespace

Status addInstances(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf) {
    if (!input.scene || input.scene->empty()) return Done{};
    const bool gpu = option(input, "places", "nodes") == "gpu";
    if (gpu && option(input, "pack", "none") != "none")
        return Error{Error::Kind::Usage,
                     "--format-option places=gpu: packed meshes have scaled nodes, which instances would scale again; "
                     "leave out pack or places"};
    std::vector<int> meshOf;
    if (const Status s = addMeshes(model, input, modelOf, meshOf); !s.ok()) return s;
    gpu ? addGpuPlaces(model, *input.scene, meshOf) : addPlaces(model, *input.scene, meshOf);
    return Done{};
}

}  // namespace sgm::exporter
