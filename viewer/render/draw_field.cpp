// Whole pictures of a field without a window. Pixels on edges are sampled again.
#include <chrono>
#include <ctime>
#include <optional>

#include "viewer/render/field_scene.h"
#include "viewer/render/scene.h"

namespace sgm::render {
namespace {

/// Adds the display light of every job to its pixel, and what its ray met to the layers.
Status addJobs(const std::vector<Job>& jobs, FieldScene& scene, PixelSums& sums, const View& view, Layers* layers,
               DrawCost& cost, Progress* progress) {
    if (progress) progress->begin("draw", jobs.size() * 4);  // traced, their normals, their light, coloured
    for (size_t first = 0; first < jobs.size(); first += mostJobs) {
        const std::span chunk = std::span(jobs).subspan(first, std::min(mostJobs, jobs.size() - first));
        const Result<Rays> rays = scene.draw(chunk, progress);
        if (!rays) return rays.error();
        for (const Job& job : chunk)
            if (cost.samples++ % 64 == 0) cost.probes.push_back(job.place());
        sums.add(chunk, rays->colors);
        for (size_t i = 0; layers && i < chunk.size(); ++i) {
            const Hit& hit = rays->hits[i];
            if (hit.kind() == HitKind::Sky) continue;
            const size_t pixel = sums.index(chunk[i]) / 4;
            layers->position[pixel] = hit.position;
            layers->depth[pixel] = static_cast<float>(dot(hit.position.as<double>() - view.eye, view.forward));
            layers->normal[pixel] = rays->shadings[i].normal;
            layers->ao[pixel] = rays->shadings[i].openness;
            layers->origin[pixel] = static_cast<float>(rays->origins[i]);
        }
    }
    return Done{};
}

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Layers emptyLayers(int width, int height) {
    const size_t count = size_t(width) * size_t(height);
    const std::vector<Vec3f> none(count, Vec3f{});
    return {width,
            height,
            none,
            std::vector<float>(count, Layers::farAway),
            none,
            none,
            std::vector<float>(count, 0.0f),
            std::vector<float>(count, 1.0f)};
}

}  // namespace

struct FieldPainter::Parts {
    GpuContext gpu;
    std::optional<FieldScene> scene;
    DrawCost cost;
};

Result<FieldPainter> FieldPainter::create(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                                          int threads, Progress* progress, TracedBy by) {
    if (Status status = checkBounds(bounds); !status) return status.error();
    const double start = secondsNow();
    Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    Result<PreparedField> prepared = prepareField(tape, bounds, provenance, threads, progress, cellDepth(by));
    if (!prepared) return prepared.error();
    auto parts = std::shared_ptr<Parts>(new Parts{std::move(*gpu), {}, {}});
    auto programs = programsFor(*prepared, nullptr, by);
    if (!programs) return programs.error();
    parts->scene.emplace(std::move(*prepared), std::move(*programs), threads);
    parts->cost.prepareSeconds = secondsNow() - start;
    return FieldPainter(std::move(parts));
}

Result<Image> FieldPainter::draw(const PictureOptions& options, Progress* progress, Layers* layers) {
    FieldScene& scene = *parts_->scene;
    if (Status status = checkPicture(scene.field()->bounds, options); !status) return status.error();
    const double start = secondsNow();
    const std::clock_t processor = std::clock();
    const double prepared = parts_->cost.prepareSeconds;
    const TraceCost before = scene.cost();
    parts_->cost = {};
    parts_->cost.prepareSeconds = prepared;
    scene.look(options, 1, !layers);
    const View view = viewOf(options.camera, options.width, options.height);
    if (layers) *layers = emptyLayers(options.width, options.height);
    PixelSums sums(options.width, options.height);
    const std::vector<Job> first = firstSamples(options.width, options.height);
    if (Status status = addJobs(first, scene, sums, view, layers, parts_->cost, progress); !status)
        return status.error();
    if (options.samples > 1) {
        const std::vector<Job> more = edgeSamples(first, sums, options.samples);
        if (Status status = addJobs(more, scene, sums, view, nullptr, parts_->cost, progress); !status)
            return status.error();
    }
    for (size_t i = 0; layers && i < layers->color.size(); ++i) {
        const float* sum = &sums.rgba[i * 4];
        layers->color[i] = Vec3f{sum[0], sum[1], sum[2]} / sum[3];
    }
    parts_->cost.hitEvaluations = scene.cost().hits - before.hits;
    parts_->cost.lightEvaluations = scene.cost().light - before.light;
    parts_->cost.instructions = scene.cost().instructions - before.instructions;
    parts_->cost.drawSeconds = secondsNow() - start;
    parts_->cost.drawProcessorSeconds = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
    return sums.image();
}

const DrawCost& FieldPainter::cost() const { return parts_->cost; }

Result<Image> drawField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                        const PictureOptions& options, Progress* progress) {
    if (Status status = checkPicture(bounds, options); !status) return status.error();
    Result<FieldPainter> painter = FieldPainter::create(tape, bounds, provenance, options.threads, progress);
    if (!painter) return painter.error();
    return painter->draw(options, progress);
}

}  // namespace sgm::render
