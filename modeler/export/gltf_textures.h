// The pictures of a glTF file's materials. For the files gltf*.cpp only.
#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "modeler/image/texture.h"

namespace sgm::exporter {

/// Gathers pictures while materials are added, whatever mesh they come with, and puts them into the file at the end,
/// when its other bytes are as they stay.
class GltfTextures {
public:
    /// Covers a material. Texture coordinates are metres along u and v with 1 - v stored, as MeshBuilder has them;
    /// KHR_texture_transform makes tiles of them.
    void cover(tinygltf::Material& material, const image::Texture& texture);
    /// Appends pictures, their textures and one sampler to a model that needs any.
    void embed(tinygltf::Model& model) const;

private:
    int indexOf(const image::ImageFilePtr& file);

    std::vector<image::ImageFilePtr> files_;
};

}  // namespace sgm::exporter
