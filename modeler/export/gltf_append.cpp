#include "modeler/export/gltf_append.h"

#include <algorithm>

namespace sgm::exporter {
namespace {

/// The model's number of a material, added where it has none that is equal.
int shareMaterial(tinygltf::Model& model, const tinygltf::Material& material) {
    const auto known = std::find(model.materials.begin(), model.materials.end(), material);
    if (known != model.materials.end()) return static_cast<int>(known - model.materials.begin());
    model.materials.push_back(material);
    return static_cast<int>(model.materials.size()) - 1;
}

}  // namespace

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

void addToRoot(tinygltf::Model& model, tinygltf::Node node) {
    const int number = addNode(model, std::move(node));  // before the root is looked at: the list of nodes moves
    model.nodes[0].children.push_back(number);
}

}  // namespace sgm::exporter
