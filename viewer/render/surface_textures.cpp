#include "viewer/render/surface_textures.h"

#include <algorithm>
#include <cmath>

#include "modeler/image/texture_frame.h"

namespace sgm::render {
namespace {

constexpr float most = 65535;
/// Normals of fields are found by differences: a component this small is none, so that walls stand upright.
constexpr double noise = 2e-3;

float linear(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

uint16_t word(float share) { return static_cast<uint16_t>(std::lround(most * std::clamp(share, 0.0f, 1.0f))); }

/// Whole tiles taken off: 0 … 1.
double fraction(double x) { return x - std::floor(x); }

}  // namespace

MipMap::MipMap(image::Pixels pixels, Values values) {
    Level first{pixels.width, pixels.height, {}};
    std::array<uint16_t, 256> table;
    for (size_t i = 0; i < table.size(); ++i) {
        const float share = static_cast<float>(i) / 255;
        table[i] = word(values == Values::Colors ? linear(share) : share);
    }
    first.pixels.reserve(pixels.rgba.size());
    for (const auto& p : pixels.rgba) first.pixels.push_back({table[p[0]], table[p[1]], table[p[2]]});
    levels_.push_back(std::move(first));
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const Level& fine = levels_.back();
        Level half{std::max(1u, fine.width / 2), std::max(1u, fine.height / 2), {}};
        half.pixels.reserve(size_t{half.width} * half.height);
        for (uint32_t y = 0; y < half.height; ++y)
            for (uint32_t x = 0; x < half.width; ++x) {
                std::array<uint16_t, 3> mean;
                for (size_t c = 0; c < 3; ++c) {
                    uint32_t sum = 2;
                    for (const uint32_t dy : {0u, 1u})
                        for (const uint32_t dx : {0u, 1u})
                            sum += fine.pixels[size_t{std::min(2 * y + dy, fine.height - 1)} * fine.width +
                                               std::min(2 * x + dx, fine.width - 1)][c];
                    mean[c] = static_cast<uint16_t>(sum / 4);
                }
                half.pixels.push_back(mean);
            }
        levels_.push_back(std::move(half));
    }
}

Vec3f MipMap::sample(const Level& level, double u, double v) {
    const double x = fraction(u) * level.width - .5, y = fraction(-v) * level.height - .5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = [&](double i) { return static_cast<size_t>(i < 0 ? i + level.width : i) % level.width; };
    const auto row = [&](double i) { return static_cast<size_t>(i < 0 ? i + level.height : i) % level.height; };
    Vec3f sum;
    for (const double dy : {0.0, 1.0})
        for (const double dx : {0.0, 1.0}) {
            const double share = (dx > 0 ? x - left : 1 - x + left) * (dy > 0 ? y - top : 1 - y + top);
            const auto& p = level.pixels[row(top + dy) * level.width + column(left + dx)];
            sum += Vec3f{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])} *
                   static_cast<float>(share);
        }
    return sum / most;
}

Vec3f MipMap::at(double u, double v, double side_px) const {
    const double level = std::clamp(std::log2(std::max(side_px, 1.0)), 0.0, static_cast<double>(levels_.size() - 1));
    const auto fine = static_cast<size_t>(level);
    const Vec3f near = sample(levels_[fine], u, v);
    const auto share = static_cast<float>(level - static_cast<double>(fine));
    return share > 0 ? near * (1 - share) + sample(levels_[fine + 1], u, v) * share : near;
}

Result<SurfaceTextures> SurfaceTextures::create(const Provenance& provenance, Progress* progress) {
    SurfaceTextures made;
    std::map<std::pair<image::ImageFilePtr, MipMap::Values>, std::shared_ptr<const MipMap>> maps;
    for (const Material& material : provenance.materials) {
        if (!material.texture || made.textures_.contains(material.texture)) continue;
        const image::Texture& from = *material.texture;
        Texture texture{nullptr, nullptr, nullptr, static_cast<double>(from.width_m),
                        static_cast<double>(from.height_m)};
        for (const auto& [file, to, values] :
             {std::tuple{from.color, &texture.color, MipMap::Values::Colors},
              std::tuple{from.normals, &texture.normals, MipMap::Values::Numbers},
              std::tuple{from.roughness, &texture.roughness, MipMap::Values::Numbers}}) {
            if (!file) continue;
            if (cancelled(progress)) return cancelledError();
            auto& map = maps[{file, values}];
            if (!map) {
                auto pixels = image::decode(*file);
                if (!pixels.ok()) return pixels.error();
                map = std::make_shared<const MipMap>(std::move(*pixels), values);
            }
            *to = map;
        }
        made.textures_.emplace(material.texture, std::make_shared<const Texture>(std::move(texture)));
    }
    if (!made.any()) return made;
    for (const Part& part : provenance.parts) {
        const auto& texture = provenance.materials[part.material].texture;
        made.parts_.push_back({texture ? made.textures_.at(texture) : nullptr, part.textureFrame, texture.get(),
                               part.pose.axes, part.hasFlatFaces});
    }
    return made;
}

void SurfaceTextures::apply(OriginId origin, Vec3f position, double footprint_m, SurfaceLook& look) const {
    const CoveredPart& part = parts_[origin];
    const Texture& texture = *part.texture;
    Vec3d n = part.axes.transposed() * look.normal.as<double>();
    for (int i = 0; i < 3; ++i)
        if (std::abs(n[i]) < noise) n[i] = 0;
    n = part.axes * normalized(n);
    const Vec3d p = position.as<double>();
    const image::TextureMap along = image::mapFace(part.frame.get(), part.axes, part.looks, part.flat, n, p);
    const double u = (dot(p, along.u) - along.begin_m[0]) * along.stretch[0] / texture.width_m,
                 v = (dot(p, along.v) - along.begin_m[1]) * along.stretch[1] / texture.height_m;
    const auto ask = [&](const MipMap& map) {
        return map.at(u, v, footprint_m * std::max(map.width() / texture.width_m, map.height() / texture.height_m));
    };
    if (texture.color) look.color = ask(*texture.color);
    if (texture.roughness) {
        const Vec3f told = ask(*texture.roughness);
        look.roughness = told.y;
        look.metallic *= told.z;
    }
    if (texture.normals) {
        const Vec3d t = ask(*texture.normals).as<double>() * 2 - Vec3d{1, 1, 1};
        look.normal = normalized(along.u * t.x + along.v * t.y + n * std::max(t.z, .05)).as<float>();
    }
}

}  // namespace sgm::render
