#include "viewer/render/scene.h"

#include <cmath>

namespace sgm::render {
namespace {

/// `threshold` in 0 … 1 decides which way a level between two goes.
uint8_t srgb(float linear, double threshold) {
    const double v = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<uint8_t>(std::min(255.0, std::floor(255 * s + threshold)));
}

/// Interleaved gradient noise (Jimenez 2014): evenly spread thresholds, so that pale gradients don't band.
double thresholdAt(int x, int y) {
    const double t = 0.06711056 * x + 0.00583715 * y, u = 52.9829189 * (t - std::floor(t));
    return u - std::floor(u);
}

/// A little above and to the left of the eye, so that relief shows.
Vec3d lampPosition(const Camera& camera, const View& view) {
    const Vec3d aside = normalized(view.up) * 0.06 - normalized(view.right) * 0.10;
    return camera.eye + aside * camera.lamp_m;
}

}  // namespace

View viewOf(const Camera& camera, int width, int height) {
    View view;
    view.eye = camera.eye;
    view.forward = normalized(camera.at - camera.eye);
    // Straight up or down there is no "up" to keep: any right will do.
    Vec3d right = cross(view.forward, Vec3d{0, 1, 0});
    if (length(right) < 1e-6) right = {1, 0, 0};
    const double halfHeight = std::tan(camera.fieldOfView / 2);
    view.right = normalized(right) * (halfHeight * width / height);
    view.up = normalized(cross(right, view.forward)) * halfHeight;
    view.pixelAngle = 2 * halfHeight / height;
    return view;
}

Vec3f rayThrough(const View& view, const PictureOptions& options, PicturePlace at) {
    const double x = 2 * at.x / options.width - 1, y = 1 - 2 * at.y / options.height;
    return normalized(view.forward + view.right * x + view.up * y).as<float>();
}

Vec3f sunDirection() { return normalized(Vec3f{-0.44f, 0.74f, 0.60f}); }

void setScene(const Program& program, const Box3f& bounds, const PictureOptions& options) {
    const View view = viewOf(options.camera, options.width, options.height);
    const float size = length(bounds.size());
    program.set("eye", view.eye.as<float>());
    program.set("viewForward", view.forward.as<float>());
    program.set("viewRight", view.right.as<float>());
    program.set("viewUp", view.up.as<float>());
    program.set("pictureSize", Vec3f{static_cast<float>(options.width), static_cast<float>(options.height), 0});
    program.set("pixelAngle", static_cast<float>(view.pixelAngle));
    program.set("sunDirection", sunDirection());
    program.set("sceneSize", size);
    program.set("sceneCentre", bounds.centre());
    program.set("sceneHalf", bounds.size() * 0.5f);
    program.set("groundHeight", bounds.lo.y);
    program.set("hasGround", options.ground ? 1 : 0);
    program.set("lampPosition", lampPosition(options.camera, view).as<float>());
    program.set("lampReach", static_cast<float>(options.camera.lamp_m));
}

MaterialRows materialRows(const std::vector<Material>& materials) {
    MaterialRows rows;
    for (const Material& m : materials) {
        rows.push_back({m.color.x, m.color.y, m.color.z, m.roughness});
        rows.push_back({m.metallic, 0, 0, 0});
    }
    return rows;
}

Buffer uploadMaterials(const std::vector<Material>& materials) {
    return Buffer::of<std::array<float, 4>>(materialRows(materials));
}

namespace {

Status refuse(const char* why) { return Error{Error::Kind::Input, why}; }

}  // namespace

Status checkBounds(const Box3f& bounds) {
    if (bounds.empty() || !bounds.finite() || !(length(bounds.size()) > 0))
        return refuse("there is nothing to draw: the model is empty or has no bounds");
    return Done{};
}

Status checkPicture(const Box3f& bounds, const PictureOptions& options) {
    if (options.width < 1 || options.height < 1 || options.width > 16384 || options.height > 16384)
        return refuse("a picture is 1 to 16384 pixels wide and high");
    if (options.samples < 1 || options.samples > 64) return refuse("a picture takes 1 to 64 samples a pixel");
    if (Status status = checkBounds(bounds); !status) return status;
    if (!(length(options.camera.at - options.camera.eye) > 0))
        return refuse("the camera looks at the place where it stands");
    return Done{};
}

std::array<uint8_t, 3> encodePixel(Vec3f light, int x, int y) {
    const double threshold = thresholdAt(x, y);
    return {srgb(light.x, threshold), srgb(light.y, threshold), srgb(light.z, threshold)};
}

Image encode(const std::vector<float>& rgba, int width, int height) {
    Image image{width, height, {}};
    image.rgb.reserve(rgba.size() / 4 * 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const size_t at = (size_t(y) * size_t(width) + size_t(x)) * 4;
            const std::array<uint8_t, 3> rgb = encodePixel({rgba[at], rgba[at + 1], rgba[at + 2]}, x, y);
            image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
        }
    return image;
}

}  // namespace sgm::render
