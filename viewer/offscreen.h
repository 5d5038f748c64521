// Pictures without a window: the field or its mesh, drawn over EGL surfaceless (no display and no GPU needed).
// Enters: a model's tape or mesh, a camera. Leaves: RGB pixels. Assumes a GL 4.3 driver (software is fine).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"
#include "modeler/volume/dense.h"
#include "viewer/mesh_style.h"

namespace sgm::viewer {

struct Camera {
    Vec3d eye, at;             ///< metres, object frame
    double fieldOfView = 0.7;  ///< vertical, radians
    double lamp_m = 0;         ///< reach of a warm lamp beside the eye, metres; 0 for none
    friend bool operator==(const Camera&, const Camera&) = default;
};
/// Frames `bounds` three-quarter from above: the box takes 84 % of the tighter side of the picture, centred.
Camera frame(const Box3f& bounds, double aspect);
/// The same for the solid itself, seen on a grid: closer wherever it leaves corners of its bounds empty.
Camera frame(const eval::Tape& tape, const Box3f& bounds, double aspect);
/// The part of `bounds` that may hold the solid; found on a grid, exact to about a cell.
Box3f tighten(const eval::Tape& tape, const Box3f& bounds);
/// The same for a solid seen from all sides in turn: it stays whole in every picture.
Camera frameTurning(const eval::Tape& tape, const Box3f& bounds, double aspect);
/// The camera, gone around the vertical axis through the place it looks at: by `angle` radians to its right.
Camera turned(Camera camera, double angle);
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
    int samples = 8;     ///< for a pixel on an edge, 1 … 64
    int threads = 0;     ///< for the work beside the GPU's; 0 = all
    friend bool operator==(const PictureOptions&, const PictureOptions&) = default;
};

/// What the rays through the pixels' centres met, a value a pixel, top row first. Lengths in metres, object frame.
struct Layers {
    int width = 0, height = 0;
    std::vector<Vec3f> color;     ///< display light, linear, 0 … 1; smoothed like the picture
    std::vector<float> depth;     ///< from the eye along the viewing direction; `farAway` for the sky
    std::vector<Vec3f> normal;    ///< unit; 0 for the sky
    std::vector<Vec3f> position;  ///< 0 for the sky
    std::vector<float> origin;    ///< OriginId; 0 for sky and ground
    std::vector<float> ao;        ///< share of open sky, 0 … 1; 1 for the sky

    static constexpr float farAway = 1e10f;  ///< metres; what Blender writes where nothing is
};

/// The names of the layers that a file can hold beside the colour: depth, normal, position, origin, ao.
const std::vector<std::string>& layerNames();

/// In pixels from the top left corner.
struct PicturePlace {
    double x, y;
};

/// What a picture of a field cost.
struct DrawCost {
    uint64_t samples = 0;
    uint64_t hitEvaluations = 0, lightEvaluations = 0;  ///< of the field by shortened tapes, for all samples
    uint64_t instructions = 0;                          ///< of those tapes
    std::vector<PicturePlace> probes;                   ///< every 64th sample's place in the picture, pixels
    double prepareSeconds = 0, drawSeconds = 0;         ///< once a field; this picture
    double drawProcessorSeconds = 0;                    ///< of all threads, the software GL's too
};

/// Who walks the rays: shaders, the processor's own vectors, or what is quicker here, the processor where the driver
/// has no GPU. The pictures are the same to the eye.
enum class TracedBy { Best, Gpu, Processor };

/// A field ready for pictures from any side: what no camera changes is done once. Keeps a GPU context of its own, so
/// that only one painter may live at a time.
class FieldPainter {
public:
    static Result<FieldPainter> create(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                                       int threads, Progress* progress, TracedBy by = TracedBy::Best);
    /// Fills `layers` too unless null.
    Result<Image> draw(const PictureOptions& options, Progress* progress, Layers* layers = nullptr);
    /// Of the latest picture.
    const DrawCost& cost() const;

private:
    struct Parts;
    explicit FieldPainter(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}
    std::shared_ptr<Parts> parts_;
};

/// The same for a mesh.
class MeshPainter {
public:
    static Result<MeshPainter> create(const mesh::Mesh& mesh, const Provenance& provenance, Progress* progress);
    Result<Image> draw(const PictureOptions& options, Progress* progress, const MeshStyle& style = {});

private:
    struct Parts;
    explicit MeshPainter(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}
    std::shared_ptr<Parts> parts_;
};

struct FogLook {
    float extinction_per_m = 0;  ///< deep inside; 0: 180 over the model's diagonal, so that a cloud is white and whole
    float lump_m = 1;            ///< size of the tile of billows that shape the edge
    float wisps = 0.85f;         ///< share of the edge that they eat; 0 draws the grid as it is
};

/// The same for fog: sunlight scattered once by Beer's law and Henyey and Greenstein's phase function, several times by
/// octaves of it, and the light of the sky.
class FogPainter {
public:
    /// `grid` rises from 0 at the surface to 1 at the depth to which billows may eat the edge.
    static Result<FogPainter> create(const volume::Dense& grid, const Box3f& bounds, const FogLook& look, int threads,
                                     Progress* progress);
    Result<Image> draw(const PictureOptions& options, Progress* progress);

private:
    struct Parts;
    explicit FogPainter(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}
    std::shared_ptr<Parts> parts_;
};

/// How often plain sphere tracing (Hart 1996) of the whole field evaluates it for a sample, hits, normals, shadow and
/// occlusion as `FieldPainter` asks for them: steps of |f|/L along every ray through the bounds, no cells, no longer
/// strides. Counted on the CPU, as a mean over the places.
double plainEvaluations(const eval::Tape& tape, const Box3f& bounds, const PictureOptions& options,
                        const std::vector<PicturePlace>& places);

/// One picture by sphere tracing with the Lipschitz bound in one fixed shader that interprets per-cell shortened tapes.
Result<Image> drawField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                        const PictureOptions& options, Progress* progress);
/// One picture of the mesh with the same camera, light and materials.
Result<Image> drawMesh(const mesh::Mesh& mesh, const Provenance& provenance, const PictureOptions& options,
                       Progress* progress);

/// PNG by libpng, written beside `path` and renamed into place.
Status writePng(const Image& image, const std::filesystem::path& path);

/// OpenEXR 2.0 with 32-bit floats: R, G, B and those of the layers, as depth.Z, normal.X, origin.V; `metadata` as text
/// attributes. Written beside `path` and renamed into place. Error::Usage for a name that no layer has.
Status writeExr(const Layers& layers, const std::vector<std::string>& names,
                const std::map<std::string, std::string>& metadata, const std::filesystem::path& path);

/// Values of the GLSL interpreter at points, read back; for tests that compare with the CPU.
Result<std::vector<float>> evaluateOnGpu(const eval::Tape& tape, const std::vector<Vec3f>& points);
/// The same for several tapes by one shader: a list of values for each.
struct GpuQuery {
    const eval::Tape* tape;
    std::vector<Vec3f> points;
};
Result<std::vector<std::vector<float>>> evaluateOnGpu(const std::vector<GpuQuery>& queries);

}  // namespace sgm::viewer
