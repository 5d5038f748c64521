#include "modeler/tiles/textures.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/atomic_file.h"
#include "modeler/image/texture_axes.h"
#include "modeler/tiles/tileset.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;

constexpr double sameDirection = .9999;  // cosine: half a degree

/// What a channel of sRGB is as light (IEC 61966-2-1).
double lightOf(uint8_t channel) {
    const double v = channel / 255.0;
    return v <= .04045 ? v / 12.92 : std::pow((v + .055) / 1.055, 2.4);
}

Vec3f meanOf(const image::ImageFile& file) {
    const auto pixels = image::decode(file);
    if (!pixels.ok() || pixels->rgba.empty()) return {1, 1, 1};
    std::array<double, 256> light{};
    for (size_t i = 0; i < light.size(); ++i) light[i] = lightOf(static_cast<uint8_t>(i));
    Vec3d sum;
    for (const auto& pixel : pixels->rgba) sum += Vec3d{light[pixel[0]], light[pixel[1]], light[pixel[2]]};
    return (sum / static_cast<double>(pixels->rgba.size())).as<float>();
}

}  // namespace

Vec3f TextureChart::tangentAt(Vec3f normal) const {
    Vec3f along = u - normal * dot(normal, u);
    if (length(along) < 1e-3f) along = cross(v, normal);
    return length(along) > 0 ? normalized(along) : Vec3f{1, 0, 0};
}

uint32_t TextureCharts::of(const Part& part, Vec3f normal) {
    const Mat3& axes = part.pose.axes;
    Vec3d n = normal.as<double>();
    // Rounding of small triangles mustn't turn what lies over a large one.
    for (const Vec3d& axis : {axes * Vec3d{1, 0, 0}, axes * Vec3d{0, 1, 0}, axes * Vec3d{0, 0, 1}})
        if (std::abs(dot(n, axis)) > sameDirection) n = dot(n, axis) > 0 ? axis : axis * -1.0;
    const image::TextureAxes along = part.hasFlatFaces ? image::axesInPlane(axes, n) : image::axesAlongNearest(axes, n);
    const Vec3f u = along.u.as<float>(), v = along.v.as<float>();
    const auto known = std::find_if(charts_.begin(), charts_.end(), [&](const TextureChart& c) {
        return static_cast<double>(dot(c.u, u)) > sameDirection && static_cast<double>(dot(c.v, v)) > sameDirection;
    });
    if (known != charts_.end()) return static_cast<uint32_t>(known - charts_.begin());
    charts_.push_back({u, v, {}});
    return static_cast<uint32_t>(charts_.size() - 1);
}

TextureChart movedTo(TextureChart chart, Vec3d origin, const image::Texture& texture) {
    const double u = dot(origin, chart.u.as<double>()), v = dot(origin, chart.v.as<double>());
    chart.origin = {static_cast<float>(std::fmod(u, static_cast<double>(texture.width_m))),
                    static_cast<float>(std::fmod(v, static_cast<double>(texture.height_m)))};
    return chart;
}

std::vector<image::ImageFilePtr> picturesOf(const image::Texture& texture) {
    std::vector<image::ImageFilePtr> all;
    for (const image::ImageFilePtr& file : {texture.color, texture.normals, texture.roughness})
        if (file) all.push_back(file);
    return all;
}

std::string fileNameOf(const image::ImageFile& picture) {
    return digestOf(picture.bytes) + (picture.kind == image::ImageFile::Kind::Png ? ".png" : ".jpg");
}

Status writePictures(const std::vector<Material>& materials, const fs::path& folder) {
    for (const Material& material : materials) {
        if (!material.texture) continue;
        std::error_code failed;
        fs::create_directories(folder, failed);
        if (failed) return writeError(folder, failed.message());
        for (const image::ImageFilePtr& picture : picturesOf(*material.texture)) {
            const fs::path path = folder / fileNameOf(*picture);
            if (fs::exists(path, failed)) continue;
            if (const Status written = writeFile(path, picture->bytes); !written.ok()) return written;
        }
    }
    return Done{};
}

Vec3f FarColors::of(const Material& material) {
    if (!material.texture || !material.texture->color) return material.color;
    const auto [at, fresh] = known_.try_emplace(material.texture->color);
    if (fresh) at->second = meanOf(*material.texture->color);
    return at->second;
}

}  // namespace sgm::tiles
