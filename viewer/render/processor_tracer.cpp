// Rays walked on the processor: those of a piece of the picture together, the places that they ask about gathered by
// cell.
#include <cmath>

#include "modeler/core/parallel.h"
#include "viewer/render/batched_evaluator.h"
#include "viewer/render/scene.h"

namespace sgm::render {
namespace {

/// Rays or hits that one thread walks together.
constexpr size_t pieceSize = 4096;

class ProcessorTracer final : public Tracer {
public:
    ProcessorTracer(std::shared_ptr<const PreparedField> field, int threads)
        : field_(std::move(field)), threads_(threadCount(threads)) {}

    void look(const PictureOptions& options, double fine) override {
        view_ = viewOf(options.camera, options.width, options.height);
        view_.pixelAngle /= fine;
        options_ = options;
        lamp_m_ = static_cast<float>(options.camera.lamp_m);
        side_ = field_->sideOf(view_.eye.as<float>());
    }

    Result<Hits> trace(std::span<const Ray> rays, Progress* progress) override {
        Hits met{std::vector<Hit>(rays.size()), std::vector<Vec3f>(rays.size(), Vec3f{}),
                 std::vector<float>(rays.size())};
        const Status done =
            inPieces(rays.size(), progress, [&](size_t low, size_t high, BatchedEvaluator& evaluator, TraceCost& cost) {
                tracePiece(rays.subspan(low, high - low), met, low, evaluator, cost);
            });
        if (!done) return done.error();
        return met;
    }

    Status light(What what, std::span<const Hit> hits, std::span<Shading> shadings, Progress* progress) override {
        return inPieces(hits.size(), progress,
                        [&](size_t low, size_t high, BatchedEvaluator& evaluator, TraceCost& cost) {
                            const auto hitsHere = hits.subspan(low, high - low);
                            const auto litsHere = shadings.subspan(low, high - low);
                            if (what != What::Light)
                                return setNormals(what == What::WideNormals, hitsHere, litsHere, evaluator, cost);
                            setOpenness(hitsHere, litsHere, evaluator, cost);
                            setSun(hitsHere, litsHere, evaluator, cost);
                            setDay(hitsHere, litsHere, evaluator, cost);
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
        if (!options_.ground || direction.y > -1e-4f || origin.y < ground) return -1;
        const float t = (ground - origin.y) / direction.y;
        return t < 60 * length(field_->bounds.size()) ? t : -1;
    }

    /// Sets what of `met` begins at `low`.
    void tracePiece(std::span<const Ray> rays, Hits& met, size_t low, BatchedEvaluator& evaluator,
                    TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>();
        std::vector<Vec3f> directions;
        for (const Ray& ray : rays) directions.push_back(rayThrough(view_, options_, ray.job.place()));
        std::vector<float> found = guessed(rays, directions, std::span(met.normals).subspan(low), evaluator, cost);
        std::vector<SphereTracer> walks;
        std::vector<size_t> of;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (found[i] >= 0) continue;
            of.push_back(i);
            walks.emplace_back(cells, eye, directions[i], pixelAngle(), rays[i]);
        }
        cost.hits += evaluator.follow(cells, std::span(walks), cost);
        for (size_t k = 0; k < of.size(); ++k) {
            found[of[k]] = walks[k].found();
            met.free[low + of[k]] = walks[k].freeBeside();
        }
        for (size_t i = 0; i < rays.size(); ++i) {
            float t = found[i];
            const float below = groundDistance(eye, directions[i]);
            HitKind kind = HitKind::Object;
            if (below >= 0 && (t < 0 || below < t)) {
                t = below;
                kind = HitKind::Ground;
            }
            if (t < 0) kind = HitKind::Sky;
            met.hits[low + i] = {t < 0 ? directions[i] : eye + t * directions[i], static_cast<float>(kind)};
        }
    }

    /// Distance along every ray where its guess is right, −1 where it isn't or there is none; and the normals there.
    std::vector<float> guessed(std::span<const Ray> rays, std::span<const Vec3f> directions, std::span<Vec3f> normals,
                               BatchedEvaluator& evaluator, TraceCost& cost) const {
        const CellSpace cells = space();
        std::vector<float> found(rays.size(), -1);
        std::vector<Question> questions;
        std::vector<size_t> of;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (rays[i].guess <= 0) continue;
            const Vec3f place = view_.eye.as<float>() + rays[i].guess * directions[i];
            const Cell cell = cells.cellAt(place);
            if (cell.state != CellState::Near) continue;
            of.push_back(i);
            questions.push_back({place, cell.tape});
        }
        const std::vector<BatchedEvaluator::Slope>& slopes = evaluator.slopesOf(questions, cost);
        cost.hits += questions.size();
        for (size_t k = 0; k < of.size(); ++k) {
            const float guess = rays[of[k]].guess;
            if (!cells.surfaceAt(cells.side * slopes[k].value, pixelAngle() * guess)) continue;
            found[of[k]] = guess;
            normals[of[k]] = normalOf(slopes[k], cells);
        }
        return found;
    }

    static Vec3f normalOf(const BatchedEvaluator::Slope& slope, const CellSpace& cells) {
        return cells.side * normalized(slope.gradient + Vec3f{0, 1e-20f, 0});
    }

    /// The field's derivatives at every hit of an object, a little before it: behind an edge begin other faces. Wide
    /// ones are means of four, some sixth of a pixel about it; but not where faces meet in a nook, whose light is
    /// that of either face and not what a face between them would see.
    void setNormals(bool wide, std::span<const Hit> hits, std::span<Shading> shadings, BatchedEvaluator& evaluator,
                    TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>();
        std::vector<Question> questions;
        std::vector<size_t> of;
        for (size_t i = 0; i < hits.size(); ++i) {
            shadings[i].normal = {0, 1, 0};
            if (hits[i].kind() != HitKind::Object) continue;
            const Vec3f place = hits[i].position + (eye - hits[i].position) * (0.05f * pixelAngle());
            const Cell cell = cells.cellAt(place);
            if (cell.state != CellState::Near) continue;
            of.push_back(i);
            if (!wide) {
                questions.push_back({place, cell.tape});
                continue;
            }
            const Vec3f back = eye - hits[i].position;
            const float reach = 0.15f * pixelAngle() * length(back);
            const Vec3f aside = normalized(cross(back, Vec3f{0.3f, 1, 0.2f})) * reach,
                        up = normalized(cross(back, aside)) * reach;
            for (const Vec3f off : {aside + 0.4f * up, -aside - 0.4f * up, up - 0.4f * aside, 0.4f * aside - up})
                questions.push_back({place + off, cell.tape});
        }
        const size_t each = wide ? 4 : 1;
        std::vector<BatchedEvaluator::Slope> slopes = evaluator.slopesOf(questions, cost);
        cost.light += questions.size();
        askInFrontAgain(hits, of, questions, slopes, evaluator, cost);
        for (size_t j = 0; j < of.size(); ++j) {
            BatchedEvaluator::Slope mean{0, {0, 0, 0}};
            float bend = 0;
            for (size_t k = 0; k < each; ++k) {
                const Vec3f normal = normalized(slopes[j * each + k].gradient);
                mean.gradient = mean.gradient + normal;
                bend += cells.side * dot(normal, questions[j * each + k].place - hits[of[j]].position);
            }
            const float pixel = pixelAngle() * length(eye - hits[of[j]].position);
            shadings[of[j]].normal = normalOf(wide && bend < -0.02f * pixel ? slopes[j * each] : mean, cells);
        }
    }

    /// Places that lie in the solid near a seam of two parts have the seam's normal. Those that differ from the others
    /// of their hit, `questions.size() / of.size()` each, are asked again in front of the surface.
    void askInFrontAgain(std::span<const Hit> hits, std::span<const size_t> of, const std::vector<Question>& questions,
                         std::span<BatchedEvaluator::Slope> slopes, BatchedEvaluator& evaluator,
                         TraceCost& cost) const {
        const CellSpace cells = space();
        const Vec3f eye = view_.eye.as<float>();
        const size_t each = of.empty() ? 0 : questions.size() / of.size();
        std::vector<Question> again;
        std::vector<size_t> which;
        for (size_t j = 0; j < of.size(); ++j) {
            const Vec3f hit = hits[of[j]].position;
            Vec3f outward{0, 0, 0};
            for (size_t k = j * each; k < (j + 1) * each; ++k)
                if (cells.side * slopes[k].value >= 0) outward = outward + normalOf(slopes[k], cells);
            const bool known = dot(outward, outward) > 0;
            outward = normalized(known ? outward : eye - hit);
            for (size_t k = j * each; k < (j + 1) * each; ++k) {
                if (cells.side * slopes[k].value >= 0) continue;
                if (known && dot(normalOf(slopes[k], cells), outward) > 0.98f) continue;
                const Vec3f place = questions[k].place;
                const float depth = std::max(dot(outward, hit - place), 0.0f), lift = (known ? 0.05f : 0.15f);
                again.push_back(questions[k]);
                again.back().place = place + outward * (depth + lift * pixelAt(hits[of[j]]));
                which.push_back(k);
            }
        }
        const std::vector<BatchedEvaluator::Slope>& lifted = evaluator.slopesOf(again, cost);
        cost.light += again.size();
        for (size_t i = 0; i < which.size(); ++i) slopes[which[i]] = lifted[i];
    }

    /// What a place above a hit tells of the sky that is hidden there: `nearness` is 0 where solid is as far away as
    /// the hit, 1 on a surface and 2 as deep in solid. Beside a wall half of the sky is seen; in a gap nothing.
    static float hiddenShare(float nearness) {
        return nearness < 1 ? 0.65f * std::max(nearness, 0.0f) : std::min(0.65f + 0.35f * (nearness - 1), 1.0f);
    }

    /// Share of the sky that each hit sees, from the field at growing distances along the normal.
    void setOpenness(std::span<const Hit> hits, std::span<Shading> shadings, BatchedEvaluator& evaluator,
                     TraceCost& cost) const {
        const CellSpace cells = space();
        const Box3f& box = field_->box;
        std::vector<Question> questions;
        struct Weighed {
            size_t hit;
            float enough, beyond;  ///< metres: of the field where more doesn't matter; from there to the place
            bool doubtful;
        };
        std::vector<Weighed> of;
        for (size_t i = 0; i < hits.size(); ++i) {
            shadings[i].openness = 1;  // less what is hidden, a quarter a distance
            float reach = 0.07f * cells.size;
            for (int k = 0; k < 4; ++k, reach *= 0.4f) {
                // Beyond the box nothing lies: what is near there is near its nearest place.
                const Vec3f place = hits[i].position + shadings[i].normal * reach,
                            within = max(box.lo, min(box.hi, place));
                const float beyond = length(place - within), most = std::min(reach, cells.margin),
                            enough = most - beyond;
                const Cell cell = cells.cellAt(within);
                if (enough <= 0 || cell.least >= enough) continue;
                if (cell.state == CellState::Near) {
                    of.push_back({i, enough, beyond, cell.doubtful});
                    questions.push_back({within, cell.tape});
                } else if (cell.state == CellState::Inside) {
                    shadings[i].openness -= 0.25f * hiddenShare((most + cells.margin - beyond) / most);
                }
            }
        }
        std::vector<float> free = evaluator.of(questions, cost);
        cost.light += questions.size();
        std::vector<ClearanceWalk> walks;
        std::vector<size_t> walked;
        for (size_t j = 0; j < of.size(); ++j) {
            free[j] *= cells.side;
            if (!of[j].doubtful || free[j] < 0 || free[j] > 0.95f * of[j].enough) continue;
            walked.push_back(j);
            const float pixel = pixelAngle() * length(view_.eye.as<float>() - questions[j].place);
            walks.emplace_back(cells, questions[j].place, free[j], of[j].enough, pixel);
        }
        cost.light += evaluator.follow(cells, std::span(walks), cost);
        for (size_t k = 0; k < walks.size(); ++k) free[walked[k]] = walks[k].clearance();
        for (size_t j = 0; j < of.size(); ++j)
            shadings[of[j].hit].openness -=
                0.25f * hiddenShare((of[j].enough - free[j]) / (of[j].enough + of[j].beyond));
        // A little stays even where things touch: light creeps in.
        for (Shading& lit : shadings) lit.openness = 0.08f + 0.92f * lit.openness;
    }

    /// Where a walk from a hit into the light begins.
    Vec3f startOf(const Hit& hit, Vec3f normal) const {
        return hit.position + normal * std::max(1e-4f * space().shownSize(pixelAt(hit)), 0.5f * pixelAt(hit));
    }
    float pixelAt(const Hit& hit) const { return pixelAngle() * length(view_.eye.as<float>() - hit.position); }

    /// Share of the sun's disc that each hit sees.
    void setSun(std::span<const Hit> hits, std::span<Shading> shadings, BatchedEvaluator& evaluator,
                TraceCost& cost) const {
        constexpr float radius = 0.035f;
        const CellSpace cells = space();
        const Vec3f sun = sunDirection();
        std::vector<DiscWalk> walks, partWalks;
        std::vector<size_t> of, partsOf;
        for (size_t i = 0; i < hits.size(); ++i) {
            shadings[i].sunlight = 0;
            if ((lamp_m_ > 0 && cells.side < 0) || dot(shadings[i].normal, sun) <= 0) continue;
            walks.emplace_back(cells, startOf(hits[i], shadings[i].normal), sun, radius, pixelAt(hits[i]));
            of.push_back(i);
        }
        cost.light += evaluator.follow(cells, std::span(walks), cost);
        constexpr float share = 1.0f / (1 + DiscWalk::parts), partRadius = DiscWalk::partRadius * radius;
        const std::array<Vec3f, DiscWalk::parts> directions = directionsOfParts(sun, radius);
        for (size_t j = 0; j < walks.size(); ++j) {
            const Hit& hit = hits[of[j]];
            Shading& lit = shadings[of[j]];
            const float clearance = walks[j].clearance();
            lit.sunlight = shareOfDisc(clearance);
            if (!walks[j].isPartial()) continue;
            lit.sunlight = share * shareOfPart(clearance / DiscWalk::partRadius);
            for (const Vec3f direction : directions) {
                partWalks.emplace_back(cells, startOf(hit, lit.normal), direction, partRadius,
                                       DiscWalk::partRadius * pixelAt(hit), DiscWalk::Of::Part, walks[j].freeUntil());
                partsOf.push_back(of[j]);
            }
        }
        cost.light += evaluator.follow(cells, std::span(partWalks), cost);
        for (size_t k = 0; k < partWalks.size(); ++k)
            shadings[partsOf[k]].sunlight += share * shareOfPart(partWalks[k].clearance());
    }

    /// In a hollow with a lamp: share of the day that each hit sees, by wide discs of the upper sky.
    void setDay(std::span<const Hit> hits, std::span<Shading> shadings, BatchedEvaluator& evaluator,
                TraceCost& cost) const {
        const CellSpace cells = space();
        std::vector<DiscWalk> walks;
        struct Ray {
            float* into;
            float weight;
        };
        std::vector<Ray> rays;
        for (size_t i = 0; i < hits.size(); ++i) {
            Shading& lit = shadings[i];
            lit.daylight = lamp_m_ > 0 && hits[i].kind() == HitKind::Object ? 0.0f : 1.0f;
            if (lit.daylight == 1 || cells.side < 0) continue;
            for (const Vec3f direction :
                 {Vec3f{0.7f, 0.714f, 0}, {0, 0.714f, 0.7f}, {-0.7f, 0.714f, 0}, {0, 0.714f, -0.7f}, {0, 1, 0}}) {
                const float cosine = dot(lit.normal, direction);
                if (cosine <= 0) continue;
                walks.emplace_back(cells, startOf(hits[i], lit.normal), direction, 0.3f, pixelAt(hits[i]),
                                   DiscWalk::Of::Sky);
                rays.push_back({&lit.daylight, 0.4f * cosine});
            }
        }
        cost.light += evaluator.follow(cells, std::span(walks), cost);
        for (size_t j = 0; j < rays.size(); ++j)
            *rays[j].into = std::min(*rays[j].into + rays[j].weight * shareOfDisc(walks[j].clearance()), 1.0f);
    }

    std::shared_ptr<const PreparedField> field_;
    int threads_;
    std::vector<BatchedEvaluator> answers_;  // a worker
    View view_{};
    PictureOptions options_;
    float lamp_m_ = 0, side_ = 1;
};

}  // namespace

std::unique_ptr<Tracer> processorTracer(std::shared_ptr<const PreparedField> field, int threads) {
    return std::make_unique<ProcessorTracer>(std::move(field), threads);
}

}  // namespace sgm::render
