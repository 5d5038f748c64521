// Whole pictures of a mesh without a window, tile by tile, so that no target gets too large for the driver.
#include "viewer/mesh_scene.h"
#include "viewer/scene.h"

namespace sgm::viewer {
namespace {

constexpr int tileEdge = 1024;  // pixels

}  // namespace

struct MeshPainter::Parts {
    GpuContext gpu;
    MeshScene scene;
};

Result<MeshPainter> MeshPainter::create(const mesh::Mesh& mesh, const Provenance& provenance, Progress* progress) {
    if (Status status = checkBounds(mesh.bounds()); !status) return status.error();
    const Result<PreparedMesh> prepared = prepareMesh(mesh, provenance);
    if (!prepared) return prepared.error();
    Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    auto programs = MeshPrograms::create();
    if (!programs) return programs.error();
    auto parts = std::shared_ptr<Parts>(new Parts{std::move(*gpu), MeshScene(*prepared, std::move(*programs))});
    if (Status status = parts->scene.light(progress); !status) return status.error();
    return MeshPainter(std::move(parts));
}

Result<Image> MeshPainter::draw(const PictureOptions& options, Progress* progress, const MeshStyle& style) {
    MeshScene& scene = parts_->scene;
    if (Status status = checkPicture(scene.bounds(), options); !status) return status.error();
    std::vector<float> pixels(size_t(options.width) * size_t(options.height) * 4);
    for (int y0 = 0; y0 < options.height; y0 += tileEdge)
        for (int x0 = 0; x0 < options.width; x0 += tileEdge) {
            const int width = std::min(tileEdge, options.width - x0), height = std::min(tileEdge, options.height - y0);
            const Result<ColorTarget> target = ColorTarget::create(width, height, options.samples);
            if (!target) return target.error();
            if (Status s = scene.draw(*target, x0, y0, options, style, progress); !s) return s.error();
            const std::vector<float> tile = target->read();
            for (int y = 0; y < height; ++y) {
                const size_t row = size_t(options.height - 1 - (y0 + y)) * size_t(options.width) + size_t(x0);
                std::copy_n(tile.begin() + std::ptrdiff_t(size_t(y) * size_t(width) * 4), size_t(width) * 4,
                            pixels.begin() + std::ptrdiff_t(row * 4));
            }
        }
    return encode(pixels, options.width, options.height);
}

Result<Image> drawMesh(const mesh::Mesh& mesh, const Provenance& provenance, const PictureOptions& options,
                       Progress* progress) {
    if (Status status = checkPicture(mesh.bounds(), options); !status) return status.error();
    Result<MeshPainter> painter = MeshPainter::create(mesh, provenance, progress);
    if (!painter) return painter.error();
    return painter->draw(options, progress);
}

}  // namespace sgm::viewer
