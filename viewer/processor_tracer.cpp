// Rays walked on the processor: those of a piece of the picture together, the places that they ask about gathered by
// cell.
#include <cmath>

#include "modeler/core/parallel.h"
#include "viewer/answers.h"
#include "viewer/scene.h"

namespace sgm::viewer {
namespace {

/// Jobs or hits that one thread walks together.
constexpr size_t pieceSize = 4096;

class ProcessorTracer final : public Tracer {
public:
    ProcessorTracer(std::shared_ptr<const PreparedField> field, int threads)
        : field_(std::move(field)), threads_(threadCount(threads)) {}

    void look(const PictureOptions& options, double fine) override {
        view_ = viewOf(options.camera, options.width, options.height);
        view_.pixelAngle /= fine;
        width_ = options.width;
        height_ = options.height;
        ground_ = options.ground;
        lamp_m_ = static_cast<float>(options.camera.lamp_m);
        side_ = field_->sideOf(view_.eye.as<float>());
    }

    Result<std::vector<Hit>> trace(std::span<const Job> jobs, Progress* progress) override {
        std::vector<Hit> hits(jobs.size());
        const Status done =
            inPieces(jobs.size(), progress, [&](size_t low, size_t high, Answers& answers, TraceCost& cost) {
                tracePiece(jobs.subspan(low, high - low), std::span(hits).subspan(low, high - low), answers, cost);
            });
        if (!done) return done.error();
        return hits;
    }

    Status light(What what, std::span<const Hit> hits, std::span<Lit> lits, Progress* progress) override {
        return inPieces(hits.size(), progress, [&](size_t low, size_t high, Answers& answers, TraceCost& cost) {
            const auto hitsHere = hits.subspan(low, high - low);
            const auto litsHere = lits.subspan(low, high - low);
            if (what == What::Normals) return setNormals(hitsHere, litsHere, answers, cost);
            setOpenness(hitsHere, litsHere, answers, cost);
            setSunAndDay(hitsHere, litsHere, answers, cost);
        });
    }

private:
    CellSpace space() const { return {*field_, side_}; }
    float pixelAngle() const { return static_cast<float>(view_.pixelAngle); }

    /// Calls body(low, high, answers, cost) for pieces of [0, count) on all threads.
    template <class Body>
    Status inPieces(size_t count, Progress* progress, Body&& body) {
        const size_t piece = std::clamp(count / size_t(threads_ * 4), size_t(64), pieceSize),
                     pieces = (count + piece - 1) / piece;
        std::vector<TraceCost> costs(pieces);
        while (answers_.size() < std::min(size_t(threads_), pieces)) answers_.emplace_back(field_->tree);
        parallelFor(pieces, std::min(threads_, static_cast<int>(std::max<size_t>(pieces, 1))), progress,
                    [&](size_t i, int worker) {
                        const size_t low = i * piece, high = std::min(low + piece, count);
                        body(low, high, answers_[size_t(worker)], costs[i]);
                        tick(progress, high - low);
                    });
        if (cancelled(progress)) return cancelledError();
        for (const TraceCost& cost : costs) cost_ += cost;
        return Done{};
    }

    /// Where a ray meets the ground, as a distance along it; −1 when it doesn't.
    float groundDistance(Vec3f origin, Vec3f direction) const {
        const float ground = field_->bounds.lo.y;
        if (!ground_ || direction.y > -1e-4f || origin.y < ground) return -1;
        const float t = (ground - origin.y) / direction.y;
        return t < 60 * length(field_->bounds.size()) ? t : -1;
    }

    void tracePiece(std::span<const Job> jobs, std::span<Hit> hits, Answers& answers, TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>();
        std::vector<Vec3f> directions;
        std::vector<SurfaceWalk> walks;
        for (const Job& job : jobs) {
            const PicturePlace at = job.place();
            const double x = 2 * at.x / width_ - 1, y = 1 - 2 * at.y / height_;
            directions.push_back(normalized(view_.forward + view_.right * x + view_.up * y).as<float>());
            walks.emplace_back(cells, eye, directions.back(), pixelAngle());
        }
        cost.hits += answers.follow(cells, std::span(walks), cost);
        for (size_t i = 0; i < jobs.size(); ++i) {
            float t = walks[i].found();
            const float below = groundDistance(eye, directions[i]);
            HitKind kind = HitKind::Object;
            if (below >= 0 && (t < 0 || below < t)) {
                t = below;
                kind = HitKind::Ground;
            }
            if (t < 0) kind = HitKind::Sky;
            hits[i] = {t < 0 ? directions[i] : eye + t * directions[i], static_cast<float>(kind)};
        }
    }

    /// Tetrahedral differences at every hit of an object; the cells' tapes are exact a little beyond the cells.
    void setNormals(std::span<const Hit> hits, std::span<Lit> lits, Answers& answers, TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>();
        const auto corner = [](int i) {
            return Vec3f{float((i + 3) >> 1 & 1), float(i >> 1 & 1), float(i & 1)} * 2.0f - Vec3f{1, 1, 1};
        };
        std::vector<Question> questions;
        std::vector<size_t> of;
        for (size_t i = 0; i < hits.size(); ++i) {
            lits[i].normal = {0, 1, 0};
            if (hits[i].kind() != HitKind::Object) continue;
            const Cell cell = cells.cellAt(hits[i].position);
            if (cell.state != CellState::Near) continue;
            const float h = std::max(2e-5f * cells.size, 0.4f * pixelAngle() * length(eye - hits[i].position));
            of.push_back(i);
            for (int k = 0; k < 4; ++k) questions.push_back({hits[i].position + corner(k) * h, cell.tape});
        }
        const std::vector<float>& values = answers.of(questions, cost);
        cost.light += questions.size();
        for (size_t j = 0; j < of.size(); ++j) {
            Vec3f sum{0, 1e-20f, 0};
            for (int k = 0; k < 4; ++k) sum += corner(k) * values[4 * j + size_t(k)];
            lits[of[j]].normal = cells.side * normalized(sum);
        }
    }

    /// Share of the sky that each hit sees, from the field at growing distances along the normal.
    void setOpenness(std::span<const Hit> hits, std::span<Lit> lits, Answers& answers, TraceCost& cost) const {
        const CellSpace cells = space();
        const Box3f& box = field_->box;
        std::vector<Question> questions;
        struct Weighed {
            size_t hit;
            float enough;
        };
        std::vector<Weighed> of;
        for (size_t i = 0; i < hits.size(); ++i) {
            lits[i].openness = 1;  // less what is hidden, a quarter a distance
            float reach = 0.07f * cells.size;
            for (int k = 0; k < 4; ++k, reach *= 0.4f) {
                const float enough = std::min(reach, cells.margin);
                const Vec3f place = hits[i].position + lits[i].normal * reach;
                if (!box.contains(place)) continue;
                const Cell cell = cells.cellAt(place);
                if (cell.least >= enough) continue;
                if (cell.state == CellState::Near) {
                    of.push_back({i, enough});
                    questions.push_back({place, cell.tape});
                } else if (cell.state == CellState::Inside) {
                    lits[i].openness -= 0.25f;
                }
            }
        }
        const std::vector<float>& values = answers.of(questions, cost);
        cost.light += questions.size();
        for (size_t j = 0; j < of.size(); ++j)
            lits[of[j].hit].openness -= 0.25f * (1 - std::clamp(cells.side * values[j] / of[j].enough, 0.0f, 1.0f));
        // A little stays even where things touch: light creeps in.
        for (Lit& lit : lits) lit.openness = 0.08f + 0.92f * lit.openness;
    }

    /// Share of the sun's disc that each hit sees; in a hollow with a lamp that of the day, by wide discs of the upper
    /// sky.
    void setSunAndDay(std::span<const Hit> hits, std::span<Lit> lits, Answers& answers, TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>(), sun = sunDirection();
        std::vector<DiscWalk> walks;
        struct Ray {
            float* into;
            float weight;
        };
        std::vector<Ray> rays;
        for (size_t i = 0; i < hits.size(); ++i) {
            Lit& lit = lits[i];
            lit.sunlight = 0;
            lit.daylight = lamp_m_ > 0 && hits[i].kind() == HitKind::Object ? 0.0f : 1.0f;
            const Vec3f start =
                hits[i].position +
                lit.normal * std::max(1e-4f * cells.size, 0.5f * pixelAngle() * length(eye - hits[i].position));
            if ((lamp_m_ == 0 || cells.side > 0) && dot(lit.normal, sun) > 0) {
                walks.emplace_back(cells, start, sun, 0.035f);
                rays.push_back({&lit.sunlight, 1});
            }
            if (lit.daylight == 1 || cells.side < 0) continue;
            for (const Vec3f direction :
                 {Vec3f{0.7f, 0.714f, 0}, {0, 0.714f, 0.7f}, {-0.7f, 0.714f, 0}, {0, 0.714f, -0.7f}, {0, 1, 0}}) {
                const float cosine = dot(lit.normal, direction);
                if (cosine <= 0) continue;
                walks.emplace_back(cells, start, direction, 0.3f);
                rays.push_back({&lit.daylight, 0.4f * cosine});
            }
        }
        cost.light += answers.follow(cells, std::span(walks), cost);
        for (size_t j = 0; j < rays.size(); ++j)
            *rays[j].into = std::min(*rays[j].into + rays[j].weight * walks[j].seen(), 1.0f);
    }

    std::shared_ptr<const PreparedField> field_;
    int threads_;
    std::vector<Answers> answers_;  // a worker
    View view_{};
    int width_ = 0, height_ = 0;
    bool ground_ = false;
    float lamp_m_ = 0, side_ = 1;
};

}  // namespace

std::unique_ptr<Tracer> processorTracer(std::shared_ptr<const PreparedField> field, int threads) {
    return std::make_unique<ProcessorTracer>(std::move(field), threads);
}

}  // namespace sgm::viewer
