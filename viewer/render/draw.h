// Pictures without a window: the field, its mesh or fog, drawn over EGL surfaceless (no display and no GPU needed).
// Enters: a model's tape, mesh or grid, and a camera. Leaves: RGB pixels. Assumes a GL 4.3 driver (software is fine).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"
#include "modeler/volume/dense.h"
#include "viewer/render/camera.h"
#include "viewer/render/mesh_style.h"
#include "viewer/render/picture.h"

namespace sgm::render {

/// What a picture shows, and how carefully.
struct PictureOptions {
    int width = 640, height = 640;
    Camera camera;
    bool ground = true;  ///< a plane under the object that takes its shadow
    int samples = 8;     ///< for a pixel on an edge, 1 … 64
    int threads = 0;     ///< for the work beside the GPU's; 0 = all
    friend bool operator==(const PictureOptions&, const PictureOptions&) = default;
};

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

}  // namespace sgm::render
