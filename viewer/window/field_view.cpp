#include "viewer/window/field_view.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "modeler/core/stopwatch.h"
#include "viewer/render/scene.h"

namespace sgm::window {
namespace {

constexpr double coarseSeconds = 0.05, batchSeconds = 0.018;

/// Pixels along an edge of the squares in which the picture fills.
constexpr int tile = 32;

/// Every pixel once, tile by tile, the tiles from the middle outwards.
std::vector<render::Job> fromTheMiddle(int width, int height) {
    std::vector<render::Job> jobs = render::firstSamples(width, height);
    const auto away = [&](const render::Job& job) {
        const int i = static_cast<int>(job.x()) / tile, j = static_cast<int>(job.y()) / tile;
        const double x = i * tile + tile / 2 - width / 2.0, y = j * tile + tile / 2 - height / 2.0;
        return std::pair(x * x + y * y, j * 4096 + i);
    };
    std::stable_sort(jobs.begin(), jobs.end(),
                     [&](const render::Job& a, const render::Job& b) { return away(a) < away(b); });
    return jobs;
}

}  // namespace

std::shared_ptr<const render::PreparedField> FieldView::setField(std::unique_ptr<render::FieldScene> scene) {
    std::swap(scene_, scene);
    if (!drawsFog()) restart();
    if (!scene) return nullptr;
    auto last = scene->field();
    scene.reset();  // here, lest it outlives the one who is to free the field
    return last;
}

void FieldView::setFog(std::unique_ptr<render::FogScene> fog) {
    const bool drew = drawsFog();
    fog_ = std::move(fog);
    if (drew || drawsFog()) restart();
}

void FieldView::showFog(bool fog) {
    if (fog == fogWanted_) return;
    fogWanted_ = fog;
    if (fog_) restart();
}

void FieldView::point(const render::PictureOptions& options, double fine) {
    drawsFog() ? fog_->look(options) : scene_->look(options, fine);
}

Result<std::vector<std::array<float, 4>>> FieldView::colorsOf(std::span<const render::Job> jobs) {
    if (drawsFog()) return fog_->draw(jobs, nullptr);
    Result<render::Rays> rays = scene_->draw(jobs, nullptr);
    if (!rays) return rays.error();
    return std::move(rays->colors);
}

void FieldView::setLook(const render::PictureOptions& options) {
    if (options == look_ && phase_ != Phase::Idle) return;
    if (options.width != look_.width || options.height != look_.height) first_.clear();
    look_ = options;
    restart();
}

void FieldView::restart() { phase_ = scene_ && look_.width > 0 && look_.height > 0 ? Phase::Coarse : Phase::Idle; }

double FieldView::share() const {
    if (phase_ < Phase::First) return 0;
    const double done = jobs_.empty() ? 1 : static_cast<double>(next_) / static_cast<double>(jobs_.size());
    return phase_ == Phase::First ? 0.8 * done : phase_ == Phase::Edges ? 0.8 + 0.2 * done : 1;
}

Status FieldView::drawCoarse() {
    const double pixels = static_cast<double>(look_.width) * look_.height;
    double& perRay = secondsPerRay_[drawsFog()];
    const double scale = std::clamp(std::sqrt(pixels * perRay / coarseSeconds), 1.0, 10.0);
    render::PictureOptions small = look_;
    small.width = std::max(1, static_cast<int>(std::ceil(look_.width / scale)));
    small.height = std::max(1, static_cast<int>(std::ceil(look_.height / scale)));
    // A block's surface is as exact as a pixel's, lest edges get dark rims.
    point(small, scale);
    const std::vector<render::Job> jobs = render::firstSamples(small.width, small.height);
    render::PixelSums sums(small.width, small.height);
    const Stopwatch watch;
    for (size_t first = 0; first < jobs.size(); first += render::mostJobs) {
        const std::span chunk = std::span(jobs).subspan(first, std::min(render::mostJobs, jobs.size() - first));
        const auto colors = colorsOf(chunk);
        if (!colors) return colors.error();
        sums.add(chunk, *colors);
    }
    times_.coarse = watch.seconds();
    times_.full = 0;
    perRay = 0.5 * perRay + 0.5 * watch.seconds() / static_cast<double>(jobs.size());
    coarse_.resize(small.width, small.height);
    coarse_.write(sums.bytes(0, 0, small.width, small.height), 0, 0, small.width, small.height);

    point(look_);
    fine_.resize(look_.width, look_.height);
    sums_ = render::PixelSums(look_.width, look_.height);
    fine_.write(sums_.bytes(0, 0, look_.width, look_.height), 0, 0, look_.width, look_.height);
    if (first_.empty()) first_ = fromTheMiddle(look_.width, look_.height);
    jobs_ = first_;
    next_ = 0;
    phase_ = Phase::First;
    return Done{};
}

Status FieldView::drawBatch() {
    const std::span chunk = std::span(jobs_).subspan(next_, std::min(batch_, jobs_.size() - next_));
    const Stopwatch watch;
    const auto colors = colorsOf(chunk);
    if (!colors) return colors.error();
    sums_.add(chunk, *colors);
    std::set<std::pair<int, int>> tiles;
    for (const render::Job& job : chunk)
        tiles.emplace(static_cast<int>(job.x()) / tile, static_cast<int>(job.y()) / tile);
    for (const auto& [i, j] : tiles) {
        const int x = i * tile, y = j * tile, width = std::min(tile, look_.width - x),
                  height = std::min(tile, look_.height - y);
        fine_.write(sums_.bytes(x, y, width, height), x, y, width, height);
    }
    times_.full += watch.seconds();
    const double wanted = static_cast<double>(chunk.size()) * std::clamp(batchSeconds / watch.seconds(), 0.25, 2.0);
    if (chunk.size() == batch_) batch_ = std::clamp(static_cast<size_t>(wanted), size_t(256), render::mostJobs);
    next_ += chunk.size();
    return Done{};
}

Status FieldView::step() {
    const ElapsedWatch watch;
    const Status done = drawMore();
    times_.drawn += watch.spent();
    return done;
}

Status FieldView::drawMore() {
    if (phase_ == Phase::Idle || phase_ == Phase::Finished) return Done{};
    if (phase_ == Phase::Coarse) return drawCoarse();
    if (next_ < jobs_.size())
        if (Status s = drawBatch(); !s) return s;
    if (next_ < jobs_.size()) return Done{};
    if (phase_ == Phase::First && look_.samples > 1) {
        jobs_ = edgeSamples(first_, sums_, look_.samples);
        next_ = 0;
        phase_ = Phase::Edges;
    } else {
        phase_ = Phase::Finished;
    }
    return Done{};
}

std::optional<Pick> FieldView::pick(int x, int y) {
    if (!scene_ || x < 0 || y < 0 || x >= look_.width || y >= look_.height) return std::nullopt;
    scene_->look(look_);
    const render::Job job{static_cast<uint32_t>(x) | static_cast<uint32_t>(y) << 16, 0};
    const Result<render::Rays> rays = scene_->trace({&job, 1}, nullptr);
    if (!rays) return std::nullopt;
    return Pick{rays->hits[0].kind(), rays->hits[0].position, rays->origins[0]};
}

}  // namespace sgm::window
