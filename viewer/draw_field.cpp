// A whole picture of a field without a window. Pixels on edges are sampled again.
#include "viewer/field_scene.h"
#include "viewer/scene.h"

namespace sgm::viewer {
namespace {

/// Adds the display light of every job to its pixel.
Status addJobs(const std::vector<Job>& jobs, FieldScene& scene, PixelSums& sums, Progress* progress) {
    if (progress) progress->begin("draw", jobs.size() * 2);
    for (size_t first = 0; first < jobs.size(); first += mostJobs) {
        const std::span chunk = std::span(jobs).subspan(first, std::min(mostJobs, jobs.size() - first));
        const Result<Rays> rays = scene.draw(chunk, progress);
        if (!rays) return rays.error();
        for (size_t i = 0; i < chunk.size(); ++i)
            for (size_t c = 0; c < 4; ++c) sums.rgba[sums.index(chunk[i]) + c] += rays->colors[i][c];
    }
    return Done{};
}

}  // namespace

Result<Image> drawField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                        const PictureOptions& options, Progress* progress) {
    if (Status status = checkPicture(bounds, options); !status) return status.error();
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    Result<PreparedField> prepared = prepareField(tape, bounds, provenance, options.threads, progress);
    if (!prepared) return prepared.error();
    FieldPrograms programs;
    if (Status status = programs.extendTo(*prepared); !status) return status.error();
    FieldScene scene(std::make_shared<const PreparedField>(std::move(*prepared)), programs, options.threads);
    scene.look(options);

    PixelSums sums(options.width, options.height);
    const std::vector<Job> first = firstSamples(options.width, options.height);
    if (Status status = addJobs(first, scene, sums, progress); !status) return status.error();
    if (options.samples > 1)
        if (Status status = addJobs(edgeSamples(first, sums, options.samples), scene, sums, progress); !status)
            return status.error();
    return sums.image();
}

}  // namespace sgm::viewer
