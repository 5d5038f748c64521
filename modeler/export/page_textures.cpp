#include "modeler/export/page_textures.h"

#include <algorithm>

#include "modeler/export/surface.h"

namespace sgm::exporter {

using Json = nlohmann::ordered_json;

PageTextures::PageTextures(const mesh::Mesh& mesh, const Provenance& provenance) {
    for (const Material& material : provenance.materials) {
        if (!material.texture) continue;
        for (const auto* file : {&material.texture->color, &material.texture->normals, &material.texture->roughness})
            if (*file && numbers_.try_emplace(file->get(), static_cast<int>(files_.size())).second)
                files_.push_back(*file);
    }
    if (files_.empty()) return;
    charts_ = chartTexture("scope", mesh, provenance);
    charts_.axes.insert(charts_.axes.begin(), ChartAxes{});
    size_t triangle = 0;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins) {
            uint32_t& chart = charts_.ofTriangle[triangle++];
            chart = provenance.materials[materialIndex(provenance, origin)].texture ? chart + 1 : 0;
        }
}

int PageTextures::number(const image::ImageFilePtr& file) const { return file ? numbers_.at(file.get()) : -1; }

Json PageTextures::ofMaterial(const Material& material) const {
    if (!material.texture) return nullptr;
    const image::Texture& t = *material.texture;
    return {{"width", t.width_m},
            {"height", t.height_m},
            {"color", number(t.color)},
            {"normals", number(t.normals)},
            {"roughness", number(t.roughness)}};
}

Json PageTextures::chartList() const {
    Json all = Json::array();
    for (const ChartAxes& a : charts_.axes)
        all.push_back(
            {a.u.x, a.u.y, a.u.z, a.begin_m[0], a.stretch[0], a.v.x, a.v.y, a.v.z, a.begin_m[1], a.stretch[1]});
    return all;
}

Json PageTextures::fileList() const {
    Json all = Json::array();
    for (const auto& file : files_) all.push_back({{"type", file->mimeType()}, {"length", file->bytes.size()}});
    return all;
}

void PageTextures::appendBytes(std::vector<uint8_t>& bytes) const {
    for (const auto& file : files_) bytes.insert(bytes.end(), file->bytes.begin(), file->bytes.end());
}

}  // namespace sgm::exporter
