// The textures of a page: how they lie on the model, and the picture files that the page carries.
// Enters: a mesh with its provenance. Leaves: charts of the triangles that textures cover, JSON and bytes. Assumes what
// `write` has checked.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "modeler/export/texture.h"
#include "modeler/image/texture.h"

namespace sgm::exporter {

class PageTextures {
public:
    /// Empty where no material has a texture.
    PageTextures(const mesh::Mesh& mesh, const Provenance& provenance);

    bool empty() const { return files_.empty(); }
    /// By triangle of the mesh, for cutIntoPatches: 0 where nothing covers it.
    const std::vector<uint32_t>& charts() const { return charts_.ofTriangle; }
    /// A material's texture: its tile in metres and its pictures by place in `files`, -1 for none; null without one.
    nlohmann::ordered_json ofMaterial(const Material& material) const;
    /// Charts as [u.x, u.y, u.z, begin, stretch, v.x, v.y, v.z, begin, stretch].
    nlohmann::ordered_json chartList() const;
    /// The files' kinds and lengths, in the order of their bytes.
    nlohmann::ordered_json fileList() const;
    void appendBytes(std::vector<uint8_t>& bytes) const;

private:
    int number(const image::ImageFilePtr& file) const;

    TextureCharts charts_;
    std::vector<image::ImageFilePtr> files_;
    std::map<const image::ImageFile*, int> numbers_;
};

}  // namespace sgm::exporter
