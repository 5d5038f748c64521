#include "modeler/export/gltf_levels.h"

#include <algorithm>

#include "modeler/export/formats.h"
#include "modeler/export/levels.h"

namespace sgm::exporter {
namespace {

/// The model's number of a material, added where it has none that is equal.
int shareMaterial(tinygltf::Model& model, const tinygltf::Material& material) {
    const auto known = std::find(model.materials.begin(), model.materials.end(), material);
    if (known != model.materials.end()) return static_cast<int>(known - model.materials.begin());
    model.materials.push_back(material);
    return static_cast<int>(model.materials.size()) - 1;
}

/// Appends the first mesh of another model, with all of its buffer; its number.
int appendMesh(tinygltf::Model& model, const tinygltf::Model& other) {
    auto& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    const size_t offset = data.size();
    data.insert(data.end(), other.buffers[0].data.begin(), other.buffers[0].data.end());
    const auto firstView = static_cast<int>(model.bufferViews.size());
    const auto firstAccessor = static_cast<int>(model.accessors.size());
    for (tinygltf::BufferView view : other.bufferViews) {
        view.byteOffset += offset;
        model.bufferViews.push_back(std::move(view));
    }
    for (tinygltf::Accessor accessor : other.accessors) {
        accessor.bufferView += firstView;
        model.accessors.push_back(std::move(accessor));
    }
    tinygltf::Mesh mesh = other.meshes[0];
    for (tinygltf::Primitive& primitive : mesh.primitives) {
        for (auto& [name, index] : primitive.attributes) index += firstAccessor;
        primitive.indices += firstAccessor;
        primitive.material = shareMaterial(model, other.materials[static_cast<size_t>(primitive.material)]);
    }
    model.meshes.push_back(std::move(mesh));
    return static_cast<int>(model.meshes.size()) - 1;
}

int addNode(tinygltf::Model& model, tinygltf::Node node) {
    model.nodes.push_back(std::move(node));
    return static_cast<int>(model.nodes.size()) - 1;
}

/// Moves what hangs on node 0 to a new node below it.
int moveToLevel0(tinygltf::Model& model, const std::string& name) {
    tinygltf::Node node;
    node.name = name;
    node.mesh = std::exchange(model.nodes[0].mesh, -1);
    node.children = std::exchange(model.nodes[0].children, {});
    const int level0 = addNode(model, std::move(node));
    model.nodes[0].children.push_back(level0);
    return level0;
}

}  // namespace

Status addLevels(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf) {
    if (input.levels.empty()) return Done{};
    const std::string name = validUtf8(input.name);
    const int finest = moveToLevel0(model, levelName(name, 0));
    tinygltf::Value::Array ids, coverages;
    for (size_t i = 0; i < input.levels.size(); ++i) {
        const auto made = modelOf(inputOfLevel(input, i + 1));
        if (!made.ok()) return made.error();
        tinygltf::Node node;
        node.name = levelName(name, i + 1);
        node.mesh = appendMesh(model, *made);
        ids.emplace_back(addNode(model, std::move(node)));
        coverages.emplace_back(input.levels[i].coverage);
        if (option(input, "levels", "scene") == "scene") model.nodes[0].children.push_back(ids.back().Get<int>());
    }
    coverages.emplace_back(0.0);  // the coarsest one is never left out
    tinygltf::Node& node = model.nodes[static_cast<size_t>(finest)];
    node.extensions["MSFT_lod"] = tinygltf::Value(tinygltf::Value::Object{{"ids", tinygltf::Value(ids)}});
    node.extras = tinygltf::Value(tinygltf::Value::Object{{"MSFT_screencoverage", tinygltf::Value(coverages)}});
    model.extensionsUsed.emplace_back("MSFT_lod");
    return Done{};
}

}  // namespace sgm::exporter
