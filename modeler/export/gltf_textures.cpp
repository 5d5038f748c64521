#include "modeler/export/gltf_textures.h"

#include <algorithm>

#include "modeler/export/formats.h"

namespace sgm::exporter {
namespace {

constexpr const char* transform = "KHR_texture_transform";

/// Tiles of the texture's size. What is stored as 1 - v has to become 1 - v / height.
tinygltf::ExtensionMap tiles(const image::Texture& texture) {
    const auto pair = [](double x, double y) {
        return tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(x), tinygltf::Value(y)});
    };
    const double u = 1 / static_cast<double>(texture.width_m), v = 1 / static_cast<double>(texture.height_m);
    return {{transform, tinygltf::Value(tinygltf::Value::Object{{"offset", pair(0, 1 - v)}, {"scale", pair(u, v)}})}};
}

}  // namespace

void GltfTextures::cover(tinygltf::Material& material, const image::Texture& texture) {
    auto& pbr = material.pbrMetallicRoughness;
    if (texture.color) {
        pbr.baseColorFactor = {1, 1, 1, 1};
        pbr.baseColorTexture.index = indexOf(texture.color);
        pbr.baseColorTexture.extensions = tiles(texture);
    }
    if (texture.roughness) {
        pbr.roughnessFactor = 1;
        pbr.metallicRoughnessTexture.index = indexOf(texture.roughness);
        pbr.metallicRoughnessTexture.extensions = tiles(texture);
    }
    if (texture.normals) {
        material.normalTexture.index = indexOf(texture.normals);
        material.normalTexture.extensions = tiles(texture);
    }
}

int GltfTextures::indexOf(const image::ImageFilePtr& file) {
    const auto known = std::find(files_.begin(), files_.end(), file);
    if (known != files_.end()) return static_cast<int>(known - files_.begin());
    files_.push_back(file);
    return static_cast<int>(files_.size()) - 1;
}

void GltfTextures::embed(tinygltf::Model& model) const {
    if (files_.empty()) return;
    tinygltf::Sampler sampler;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_REPEAT;
    model.samplers.push_back(sampler);
    for (const image::ImageFilePtr& file : files_) {
        auto& data = model.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = file->bytes.size();
        data.insert(data.end(), file->bytes.begin(), file->bytes.end());
        tinygltf::Image picture;
        picture.name = validUtf8(file->path.stem().string());
        picture.mimeType = file->mimeType();
        picture.bufferView = static_cast<int>(model.bufferViews.size());
        model.bufferViews.push_back(view);
        tinygltf::Texture texture;
        texture.source = static_cast<int>(model.images.size());
        texture.sampler = 0;
        model.images.push_back(std::move(picture));
        model.textures.push_back(texture);
    }
    model.extensionsUsed.emplace_back(transform);
}

}  // namespace sgm::exporter
