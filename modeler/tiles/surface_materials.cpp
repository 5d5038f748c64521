// The materials of a file and the pictures that cover them.
#include <cmath>
#include <filesystem>

#include "modeler/tiles/surface_buffer.h"
#include "modeler/tiles/textures.h"

namespace sgm::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* transform = "KHR_texture_transform";

}  // namespace

size_t SurfaceBuffer::materialOf(Json material) {
    const auto [at, fresh] = materials_.try_emplace(material.dump(), json()["materials"].size());
    if (fresh) json()["materials"].push_back(std::move(material));
    return at->second;
}

size_t SurfaceBuffer::textureOf(const std::string& uri) {
    Json& images = json()["images"];
    for (size_t i = 0; i < images.size(); ++i)
        if (images[i]["uri"] == uri) return i;
    constexpr int linear = 9729, linearBetweenSizes = 9987;
    if (images.empty()) json()["samplers"] = Json::array({{{"magFilter", linear}, {"minFilter", linearBetweenSizes}}});
    images.push_back({{"uri", uri}});
    json()["textures"].push_back({{"source", images.size() - 1}, {"sampler", 0}});
    return images.size() - 1;
}

/// A material with its pictures, whose texture coordinates are metres.
Json SurfaceBuffer::covered(const Material& material) {
    Json out = asJson(material);
    const image::Texture& texture = *material.texture;
    const Json tile{{"scale", {1 / static_cast<double>(texture.width_m), 1 / static_cast<double>(texture.height_m)}}};
    const auto cover = [&](Json& where, const char* slot, const image::ImageFilePtr& picture) {
        if (!picture) return false;
        where[slot] = {{"index", textureOf(pictures_ + fileNameOf(*picture))}, {"extensions", {{transform, tile}}}};
        use(transform, false);
        return true;
    };
    Json& pbr = out["pbrMetallicRoughness"];
    if (cover(pbr, "baseColorTexture", texture.color)) pbr["baseColorFactor"] = {1, 1, 1, 1};
    if (cover(pbr, "metallicRoughnessTexture", texture.roughness)) pbr["roughnessFactor"] = 1;
    cover(out, "normalTexture", texture.normals);
    return out;
}

Json SurfaceBuffer::adopted(const Json& material, const Glb& from, const std::string& folder) {
    Json out = material;
    const auto adopt = [&](Json& where, const char* slot) {
        if (!where.contains(slot)) return;
        const Json& texture = from.json.at("textures").at(where[slot].at("index").get<size_t>());
        const std::string uri = from.json.at("images").at(texture.at("source").get<size_t>()).at("uri");
        where[slot]["index"] = textureOf((std::filesystem::path(folder) / uri).lexically_normal().string());
        use(transform, false);
    };
    adopt(out["pbrMetallicRoughness"], "baseColorTexture");
    adopt(out["pbrMetallicRoughness"], "metallicRoughnessTexture");
    adopt(out, "normalTexture");
    return out;
}

Json asJson(const Material& m) {
    const auto digits = [](float v) { return std::round(static_cast<double>(v) * 1e6) / 1e6; };
    return {{"name", m.name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {digits(m.color.x), digits(m.color.y), digits(m.color.z), 1.0}},
              {"roughnessFactor", digits(m.roughness)},
              {"metallicFactor", digits(m.metallic)}}}};
}

}  // namespace sgm::tiles
