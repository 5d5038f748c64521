// What both pictures share: the view, the sun, the ground and how their numbers reach a shader.
// Enters: a camera and bounds. Leaves: uniforms. Assumes the parts view, sky, light, ground of viewer/render/shaders/.
#pragma once

#include "viewer/render/draw.h"
#include "viewer/render/gpu.h"

namespace sgm::render {

/// The camera's frame. `right` and `up` reach the picture's edges at distance 1 along `forward`.
struct View {
    Vec3d eye, forward, right, up;
    double pixelAngle;  ///< radians a pixel, at the centre
};
View viewOf(const Camera& camera, int width, int height);

/// Unit direction of the ray through a place of the picture.
Vec3f rayThrough(const View& view, const PictureOptions& options, PicturePlace at);

/// Towards the sun: behind the left shoulder of the default camera.
Vec3f sunDirection();

/// Sets every uniform of the shared parts.
void setScene(const Program& program, const Box3f& bounds, const PictureOptions& options);

/// Two rows of four floats a material: colour and roughness; metallic.
using MaterialRows = std::vector<std::array<float, 4>>;
MaterialRows materialRows(const std::vector<Material>& materials);
Buffer uploadMaterials(const std::vector<Material>& materials);

/// Error::Input when there is nothing that could be drawn.
Status checkBounds(const Box3f& bounds);

/// Error::Input when a picture of this size, with these samples and bounds, can't be drawn.
Status checkPicture(const Box3f& bounds, const PictureOptions& options);

/// 8 bits of sRGB of a pixel's display light; its place decides which way a level between two goes.
std::array<uint8_t, 3> encodePixel(Vec3f light, int x, int y);

/// 8 bits of sRGB from display light 0 … 1, four floats a pixel.
Image encode(const std::vector<float>& rgba, int width, int height);

}  // namespace sgm::render
