#include "viewer/render/fog_scene.h"

#include "viewer/render/gpu_tracer.h"
#include "viewer/render/scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {
namespace {

constexpr int billowEdge = 64;

/// The grid's outer faces: half a voxel beyond the outer voxels' centres.
Box3f boxOf(const volume::Dense& grid) {
    const Vec3f low = grid.low - Vec3f{0.5f, 0.5f, 0.5f} * grid.voxel_m;
    return {low, low + grid.count.as<float>() * grid.voxel_m};
}

}  // namespace

Result<volume::Dense> fogGrid(const eval::Tape& tape, const mesh::Grid& grid, const volume::FogOptions& options,
                              int threads, Progress* progress) {
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, threads, progress, counts);
    if (!blocks.ok()) return blocks.error();
    const auto level = volume::sample(*blocks, tape, grid, volume::usualHalfWidth, threads, progress);
    if (!level.ok()) return level.error();
    volume::FogOptions shares = options;
    shares.density = 1;
    const auto fog = volume::fog(*level, shares, progress);
    if (!fog.ok()) return fog.error();
    return volume::dense(*fog, 1);
}

Result<FogGrid> fogGrid(const eval::Tape& tape, const mesh::Grid& grid, const Box3f& bounds, int threads,
                        Progress* progress) {
    const Vec3f size = bounds.size();
    const float edge_m = std::min({size.x, size.y, size.z}) / 15;
    auto dense = fogGrid(tape, grid, volume::FogOptions{.edge_m = static_cast<double>(edge_m)}, threads, progress);
    if (!dense.ok()) return dense.error();
    return FogGrid{std::move(*dense), edge_m};
}

Result<PreparedFog> prepareFog(const volume::Dense& grid, const Box3f& bounds, const FogLook& look, int threads,
                               Progress* progress) {
    const float extinction = look.extinction_per_m > 0 ? look.extinction_per_m : 180 / length(bounds.size());
    Result<FogTexels> texels = lightFog(grid, extinction, 0.5f * look.wisps, sunDirection(), threads, progress);
    if (!texels) return texels.error();
    return PreparedFog{std::move(*texels), grid.count, boxOf(grid), bounds,
                       grid.voxel_m,       extinction, look.lump_m, look.wisps};
}

Result<std::shared_ptr<const FogPrograms>> FogPrograms::create() {
    const auto programs = std::make_shared<FogPrograms>();
    Result<Program> program = Program::compute(shaderText("fog"));
    if (!program) return program.error();
    programs->program = std::move(*program);
    programs->billows = VolumeTexture::of(render::billows(billowEdge), {billowEdge, billowEdge, billowEdge},
                                          VolumeTexture::Edge::Repeat);
    return std::shared_ptr<const FogPrograms>(programs);
}

FogScene::FogScene(const PreparedFog& fog, std::shared_ptr<const FogPrograms> programs)
    : programs_(std::move(programs)),
      grid_(VolumeTexture::of(fog.texels.rgba, fog.count)),
      bricks_(VolumeTexture::of(fog.texels.bricks, fog.texels.brickCount, VolumeTexture::Edge::Nearest)),
      count_(fog.count),
      box_(fog.box),
      bounds_(fog.bounds),
      voxel_m_(fog.voxel_m),
      extinction_per_m_(fog.extinction_per_m),
      lump_m_(fog.lump_m),
      wisps_(fog.wisps) {}

void FogScene::look(const PictureOptions& options) {
    const Program& p = programs_->program;
    setScene(p, bounds_, options);
    p.set("fogGrid", 0);
    p.set("bricks", 1);
    p.set("billowing", 2);
    p.set("fogLow", box_.lo);
    p.set("fogCount", count_.as<float>());
    p.set("voxel", voxel_m_);
    p.set("extinction", extinction_per_m_);
    p.set("wisps", wisps_);
    p.set("lump", lump_m_);
    p.set("mostSunDepth", FogTexels::mostSunDepth);
}

Result<std::vector<std::array<float, 4>>> FogScene::draw(std::span<const Job> jobs, Progress* progress) {
    grid_.bind(0);
    bricks_.bind(1);
    programs_->billows.bind(2);
    const Buffer jobBuffer = Buffer::of(jobs);
    const Buffer colors = Buffer::ofBytes(nullptr, jobs.size() * 4 * sizeof(float));
    jobBuffer.bindStorage(1);
    colors.bindStorage(5);
    if (Status s = runInPieces(programs_->program, jobs.size(), piece_, progress); !s) return s.error();
    return colors.read<std::array<float, 4>>(jobs.size());
}

}  // namespace sgm::render
