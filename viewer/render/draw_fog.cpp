// Whole pictures of fog without a window.
#include "viewer/render/field_scene.h"
#include "viewer/render/fog_scene.h"
#include "viewer/render/scene.h"

namespace sgm::render {

struct FogPainter::Parts {
    GpuContext gpu;
    FogScene scene;
};

Result<FogPainter> FogPainter::create(const volume::Dense& grid, const Box3f& bounds, const FogLook& look, int threads,
                                      Progress* progress) {
    if (Status status = checkBounds(bounds); !status) return status.error();
    const Result<PreparedFog> fog = prepareFog(grid, bounds, look, threads, progress);
    if (!fog) return fog.error();
    Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    auto programs = FogPrograms::create();
    if (!programs) return programs.error();
    FogScene scene(*fog, std::move(*programs));
    return FogPainter(std::shared_ptr<Parts>(new Parts{std::move(*gpu), std::move(scene)}));
}

Result<Image> FogPainter::draw(const PictureOptions& options, Progress* progress) {
    FogScene& scene = parts_->scene;
    if (Status status = checkPicture(scene.bounds(), options); !status) return status.error();
    scene.look(options);
    PixelSums sums(options.width, options.height);
    const auto add = [&](const std::vector<Job>& jobs) -> Status {
        if (progress) progress->begin("draw", jobs.size());
        for (size_t first = 0; first < jobs.size(); first += mostJobs) {
            const std::span chunk = std::span(jobs).subspan(first, std::min(mostJobs, jobs.size() - first));
            const auto colors = scene.draw(chunk, progress);
            if (!colors) return colors.error();
            sums.add(chunk, *colors);
        }
        return Done{};
    };
    const std::vector<Job> first = firstSamples(options.width, options.height);
    if (Status status = add(first); !status) return status.error();
    if (options.samples > 1)
        if (Status status = add(edgeSamples(first, sums, options.samples)); !status) return status.error();
    return sums.image();
}

}  // namespace sgm::render
