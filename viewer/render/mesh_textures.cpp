#include "viewer/render/mesh_textures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "modeler/export/texture.h"
#include "viewer/render/surface_textures.h"

namespace sgm::render {
namespace {

/// Gathers pictures as layers of one size.
class PictureLayers {
public:
    /// The layer of a picture; -1 for none.
    Result<float> layerOf(const image::ImageFilePtr& file) {
        if (!file) return -1.0f;
        const auto [at, fresh] = known_.try_emplace(file, pictures.size());
        if (fresh) {
            auto pixels = image::decode(*file);
            if (!pixels.ok()) return pixels.error();
            pictures.push_back(sized(MipMap(std::move(*pixels), MipMap::Values::Numbers)));
        }
        return static_cast<float>(at->second);
    }

    std::vector<std::vector<uint8_t>> pictures;

private:
    static std::vector<uint8_t> sized(const MipMap& map) {
        const double side_px = static_cast<double>(std::max(map.width(), map.height())) / MeshTextures::edge;
        std::vector<uint8_t> rgba;
        rgba.reserve(4 * size_t{MeshTextures::edge} * MeshTextures::edge);
        for (int y = 0; y < MeshTextures::edge; ++y)
            for (int x = 0; x < MeshTextures::edge; ++x) {
                const Vec3f c = map.at((x + .5) / MeshTextures::edge, (y + .5) / MeshTextures::edge, side_px);
                for (int i = 0; i < 3; ++i) rgba.push_back(static_cast<uint8_t>(std::lround(255 * c[i])));
                rgba.push_back(255);
            }
        return rgba;
    }

    std::map<image::ImageFilePtr, size_t> known_;
};

}  // namespace

Result<MeshTextures> prepareMeshTextures(const mesh::Mesh& mesh, const Provenance& provenance) {
    MeshTextures made;
    const auto& materials = provenance.materials;
    if (std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.texture != nullptr; }))
        return made;
    const exporter::TextureCharts charts = exporter::chartTexture("scope", mesh, provenance);
    PictureLayers colors, numbers;
    std::map<std::pair<uint32_t, const image::Texture*>, uint32_t> known;
    size_t triangle = 0;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins) {
            const uint32_t chart = charts.ofTriangle[triangle++];
            const image::Texture* texture = provenance.materialOf(origin).texture.get();
            uint32_t& frame = made.frameOfTriangle.emplace_back(0);
            if (!texture) continue;
            const auto [at, fresh] = known.try_emplace({chart, texture}, static_cast<uint32_t>(made.frames.size() + 1));
            frame = at->second;
            if (!fresh) continue;
            const auto color = colors.layerOf(texture->color), normals = numbers.layerOf(texture->normals),
                       roughness = numbers.layerOf(texture->roughness);
            for (const auto* layer : {&color, &normals, &roughness})
                if (!layer->ok()) return layer->error();
            const exporter::ChartAxes& axes = charts.axes[chart];
            const float acrossTile = axes.stretch[0] / texture->width_m, upTile = axes.stretch[1] / texture->height_m;
            made.frames.push_back({axes.u * acrossTile,
                                   *color,
                                   axes.v * upTile,
                                   *normals,
                                   *roughness,
                                   {axes.begin_m[0] * acrossTile, axes.begin_m[1] * upTile}});
        }
    made.colors = std::move(colors.pictures);
    made.numbers = std::move(numbers.pictures);
    return made;
}

}  // namespace sgm::render
