// Pictures without a window: the field or its mesh, drawn over EGL surfaceless (no display and no GPU needed).
// Enters: a model's tape or mesh, a camera. Leaves: RGB pixels. Assumes a GL 4.3 driver (software is fine).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::viewer {

struct Camera {
    Vec3d eye, at;             ///< metres, object frame
    double fieldOfView = 0.7;  ///< vertical, radians
    double lamp_m = 0;         ///< reach of a warm lamp beside the eye, metres; 0 for none
};
/// Frames `bounds` three-quarter from above: the box takes 84 % of the tighter side of the picture, centred.
Camera frame(const Box3f& bounds, double aspect);
/// The same for the solid itself, seen on a grid: closer wherever it leaves corners of its bounds empty.
Camera frame(const eval::Tape& tape, const Box3f& bounds, double aspect);
/// The part of `bounds` that may hold the solid; found on a grid, exact to about a cell.
Box3f tighten(const eval::Tape& tape, const Box3f& bounds);
/// Stands inside the largest hollow of the field, looking along its longest free direction with a lamp (`--camera
/// inside`). A field without a hollow is taken as the hollow itself: the camera stands in its solid, which is then
/// drawn inside out.
Camera inside(const eval::Tape& tape, const Box3f& bounds);

struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  ///< width · height · 3, top row first
};

struct PictureOptions {
    int width = 640, height = 640;
    Camera camera;
    bool ground = true;  ///< a plane under the object that takes its shadow
    int samples = 4;     ///< for a pixel on an edge, 1 … 64
    int threads = 0;     ///< for the work beside the GPU's; 0 = all
};

/// Sphere tracing with the Lipschitz bound in one fixed shader that interprets per-tile shortened tapes.
Result<Image> drawField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                        const PictureOptions& options, Progress* progress);
/// The mesh with the same camera, light and materials.
Result<Image> drawMesh(const mesh::Mesh& mesh, const Provenance& provenance, const PictureOptions& options,
                       Progress* progress);

/// PNG by libpng, written beside `path` and renamed into place.
Status writePng(const Image& image, const std::filesystem::path& path);

/// Values of the GLSL interpreter at points, read back; for tests that compare with the CPU.
Result<std::vector<float>> evaluateOnGpu(const eval::Tape& tape, const std::vector<Vec3f>& points);

}  // namespace sgm::viewer
