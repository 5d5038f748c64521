// Whole pictures of fog without a window: a volume in 3D textures, marched by one shader.
#include "viewer/field_scene.h"
#include "viewer/fog_light.h"
#include "viewer/scene.h"
#include "viewer/shader_text.h"

namespace sgm::viewer {
namespace {

constexpr int billowEdge = 64;
constexpr float wisps = 0.85f, meanEaten = 0.5f * wisps;

/// The grid's outer faces: half a voxel beyond the outer voxels' centres.
Box3f boxOf(const volume::Dense& grid) {
    const Vec3f low = grid.low - Vec3f{0.5f, 0.5f, 0.5f} * grid.voxel_m;
    return {low, low + grid.count.as<float>() * grid.voxel_m};
}

}  // namespace

struct FogPainter::Parts {
    GpuContext gpu;
    Program program;
    VolumeTexture grid, bricks, billows;
    Box3f box, bounds;
    size_t piece = 2048;
};

Result<FogPainter> FogPainter::create(const volume::Dense& grid, const Box3f& bounds, const FogLook& look, int threads,
                                      Progress* progress) {
    if (Status status = checkBounds(bounds); !status) return status.error();
    const Box3f box = boxOf(grid);
    const float size = length(bounds.size());
    const float extinction = look.extinction_per_m > 0 ? look.extinction_per_m : 180 / size;
    const Result<FogTexels> texels = lightFog(grid, extinction, meanEaten, sunDirection(), threads, progress);
    if (!texels) return texels.error();
    Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    auto parts = std::shared_ptr<Parts>(new Parts{std::move(*gpu), {}, {}, {}, {}, box, bounds});
    Result<Program> program = Program::compute(shaderText("fog"));
    if (!program) return program.error();
    parts->program = std::move(*program);
    parts->grid = VolumeTexture::of(texels->rgba, grid.count);
    parts->bricks = VolumeTexture::of(texels->bricks, texels->brickCount, VolumeTexture::Edge::Nearest);
    parts->billows = VolumeTexture::of(billows(billowEdge), {billowEdge, billowEdge, billowEdge}, VolumeTexture::Edge::Repeat);
    const Program& p = parts->program;
    p.set("fogGrid", 0);
    p.set("bricks", 1);
    p.set("billowing", 2);
    p.set("fogLow", box.lo);
    p.set("fogCount", grid.count.as<float>());
    p.set("voxel", grid.voxel_m);
    p.set("extinction", extinction);
    p.set("wisps", wisps);
    p.set("lump", look.lump_m);
    p.set("mostSunDepth", FogTexels::mostSunDepth);
    return FogPainter(std::move(parts));
}

Result<Image> FogPainter::draw(const PictureOptions& options, Progress* progress) {
    if (Status status = checkPicture(parts_->bounds, options); !status) return status.error();
    setScene(parts_->program, parts_->bounds, options);
    parts_->grid.bind(0);
    parts_->bricks.bind(1);
    parts_->billows.bind(2);
    PixelSums sums(options.width, options.height);
    const auto add = [&](const std::vector<Job>& jobs) -> Status {
        if (progress) progress->begin("draw", jobs.size());
        for (size_t first = 0; first < jobs.size(); first += mostJobs) {
            const std::span chunk = std::span(jobs).subspan(first, std::min(mostJobs, jobs.size() - first));
            const Buffer jobBuffer = Buffer::of(chunk);
            const Buffer colors = Buffer::ofBytes(nullptr, chunk.size() * 4 * sizeof(float));
            jobBuffer.bindStorage(1);
            colors.bindStorage(5);
            if (Status s = runInPieces(parts_->program, chunk.size(), parts_->piece, progress); !s) return s;
            sums.add(chunk, colors.read<std::array<float, 4>>(chunk.size()));
        }
        return Done{};
    };
    const std::vector<Job> first = firstSamples(options.width, options.height);
    if (Status status = add(first); !status) return status.error();
    if (options.samples > 1)
        if (Status status = add(edgeSamples(first, sums, options.samples)); !status) return status.error();
    return sums.image();
}

}  // namespace sgm::viewer
