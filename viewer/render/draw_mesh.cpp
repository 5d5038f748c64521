// Whole pictures of a mesh without a window, tile by tile, so that no target gets too large for the driver.
#include <algorithm>
#include <optional>

#include "viewer/render/mesh_scene.h"
#include "viewer/render/pixels.h"
#include "viewer/render/scene.h"

namespace sgm::render {
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
    auto parts = std::shared_ptr<Parts>(
        new Parts{std::move(*gpu), MeshScene(*prepared, std::move(*programs), MeshScene::skyOfPictures)});
    if (Status status = parts->scene.light(progress); !status) return status.error();
    return MeshPainter(std::move(parts));
}

namespace {

/// One tile of the picture: its place from the bottom left, and its size.
struct Tile {
    int x0, y0, width, height;
    static std::vector<Tile> of(const PictureOptions& options) {
        std::vector<Tile> tiles;
        for (int y0 = 0; y0 < options.height; y0 += tileEdge)
            for (int x0 = 0; x0 < options.width; x0 += tileEdge)
                tiles.push_back(
                    {x0, y0, std::min(tileEdge, options.width - x0), std::min(tileEdge, options.height - y0)});
        return tiles;
    }
    /// Where the pixel (x, y) of the tile, from its bottom left, is in a picture whose top row is the first.
    size_t pixel(const PictureOptions& options, int x, int y) const {
        return size_t(options.height - 1 - (y0 + y)) * size_t(options.width) + size_t(x0 + x);
    }
};

/// Draws all tiles with so many samples a pixel, and calls take(pixel, colour of four floats) for every pixel.
template <class Take>
Status drawTiles(const MeshScene& scene, const PictureOptions& options, const MeshStyle& style, int samples,
                 Progress* progress, const Subsample& subsample, const std::vector<uint8_t>* wanted, Take&& take) {
    for (const Tile& tile : Tile::of(options)) {
        const Result<ColorTarget> target = ColorTarget::create(tile.width, tile.height, samples);
        if (!target) return target.error();
        Subsample here = subsample;
        std::optional<TexelBuffer> mask;
        if (wanted) {
            std::vector<uint32_t> words;
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x) words.push_back((*wanted)[tile.pixel(options, x, y)]);
            mask = TexelBuffer::of(words, 1);
            here.wanted = &*mask;
        }
        if (Status s = scene.draw(*target, tile.x0, tile.y0, options, style, progress, here); !s) return s;
        const std::vector<float> colors = target->read();
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x)
                take(tile.pixel(options, x, y), &colors[(size_t(y) * size_t(tile.width) + size_t(x)) * 4]);
    }
    return Done{};
}

/// Software shades a pixel once for every triangle in it, whatever is seen of them: pixels are sampled one by one
/// there, and again where they differ from their neighbours.
Result<Image> drawBySoftware(const MeshScene& scene, const PictureOptions& options, const MeshStyle& style,
                             Progress* progress) {
    constexpr int mostSamples = 4;
    PixelSums sums(options.width, options.height);
    const auto add = [&](size_t pixel, const float* color) {
        for (size_t k = 0; k < 3; ++k) sums.rgba[pixel * 4 + k] += color[k];
        sums.rgba[pixel * 4 + 3] += 1;
    };
    if (Status s = drawTiles(scene, options, style, 1, progress, {}, nullptr, add); !s) return s.error();
    const int samples = std::min(options.samples, mostSamples);
    if (samples < 2) return sums.image();
    std::vector<uint8_t> wanted(size_t(options.width) * size_t(options.height), 0);
    for (const Job& job : edgeSamples(firstSamples(options.width, options.height), sums, 2))
        wanted[job.y() * size_t(options.width) + job.x()] = 1;
    for (uint32_t k = 1; k < static_cast<uint32_t>(samples); ++k) {
        const PicturePlace place = Job{0, k}.place();
        const auto addWanted = [&](size_t pixel, const float* color) {
            if (wanted[pixel]) add(pixel, color);
        };
        const Subsample beside{place.x - 0.5, place.y - 0.5, nullptr};
        if (Status s = drawTiles(scene, options, style, 1, progress, beside, &wanted, addWanted); !s) return s.error();
    }
    return sums.image();
}

}  // namespace

Result<Image> MeshPainter::draw(const PictureOptions& options, Progress* progress, const MeshStyle& style) {
    MeshScene& scene = parts_->scene;
    if (Status status = checkPicture(scene.bounds(), options); !status) return status.error();
    if (style.look == MeshLook::Materials)
        if (Status status = scene.lightFor(options, progress); !status) return status.error();
    if (softwareGl()) return drawBySoftware(scene, options, style, progress);
    std::vector<float> pixels(size_t(options.width) * size_t(options.height) * 4);
    const auto put = [&](size_t pixel, const float* color) { std::copy_n(color, 4, &pixels[pixel * 4]); };
    if (Status s = drawTiles(scene, options, style, options.samples, progress, {}, nullptr, put); !s) return s.error();
    return encode(pixels, options.width, options.height);
}

Result<Image> drawMesh(const mesh::Mesh& mesh, const Provenance& provenance, const PictureOptions& options,
                       Progress* progress) {
    if (Status status = checkPicture(mesh.bounds(), options); !status) return status.error();
    Result<MeshPainter> painter = MeshPainter::create(mesh, provenance, progress);
    if (!painter) return painter.error();
    return painter->draw(options, progress);
}

}  // namespace sgm::render
