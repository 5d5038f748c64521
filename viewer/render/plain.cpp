// Plain sphere tracing on the CPU, which only counts: what the picture would cost without cells and long strides.
#include <cmath>

#include "viewer/render/draw.h"
#include "viewer/render/samples.h"
#include "viewer/render/scene.h"

namespace sgm::render {
namespace {

/// Rays that walk together; `t` is where each stands.
struct Walk {
    std::vector<Vec3f> origins, directions;
    std::vector<float> t;
    std::vector<bool> hit;
    void add(Vec3f origin, Vec3f direction) {
        origins.push_back(origin);
        directions.push_back(direction);
        t.push_back(0);
        hit.push_back(false);
    }
    Vec3f at(size_t i) const { return origins[i] + directions[i] * t[i]; }
};

/// The span of a ray inside a box; empty (x > y) when it misses it.
std::pair<float, float> span(const Box3f& box, Vec3f origin, Vec3f direction) {
    float near = 0, far = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (box.lo[axis] - origin[axis]) / direction[axis],
                    b = (box.hi[axis] - origin[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return {near, far};
}

/// Steps every ray until it meets the surface or leaves the box; gives the number of evaluations. A ray stops where the
/// field is less than `tolerance` metres, or `angle` times the way.
uint64_t march(Walk& walk, const eval::Tape& tape, const Box3f& box, float first, float tolerance, float angle) {
    const float perValue = 1 / std::max(tape.lipschitz(), 1e-6f);
    std::vector<size_t> live;
    std::vector<float> end(walk.t.size());
    for (size_t i = 0; i < walk.t.size(); ++i) {
        const auto [near, far] = span(box, walk.origins[i], walk.directions[i]);
        walk.t[i] = std::max(near, first);
        end[i] = far;
        if (walk.t[i] <= far) live.push_back(i);
    }
    uint64_t evaluations = 0;
    for (int step = 0; step < 512 && !live.empty(); ++step) {
        std::vector<Vec3f> points;
        for (const size_t i : live) points.push_back(walk.at(i));
        const std::vector<float> values = valuesAt(tape, points);
        evaluations += live.size();
        std::vector<size_t> still;
        for (size_t k = 0; k < live.size(); ++k) {
            const size_t i = live[k];
            const float least = std::max(tolerance, angle * walk.t[i]);
            walk.hit[i] = values[k] < least;
            walk.t[i] += values[k] * perValue;
            if (!walk.hit[i] && walk.t[i] <= end[i]) still.push_back(i);
        }
        live = std::move(still);
    }
    return evaluations;
}

}  // namespace

double plainEvaluations(const eval::Tape& tape, const Box3f& bounds, const PictureOptions& options,
                        const std::vector<PicturePlace>& places) {
    constexpr uint64_t forNormal = 4, forOcclusion = 4;
    const View view = viewOf(options.camera, options.width, options.height);
    const Vec3f eye = view.eye.as<float>();
    const float size = length(bounds.size()), pixel = static_cast<float>(view.pixelAngle);
    const Box3f box = bounds.inflated(0.03f * size);
    Walk seen;
    for (const PicturePlace& place : places) seen.add(eye, rayThrough(view, options, place));
    uint64_t evaluations = march(seen, tape, box, 0, 2e-6f * size, 0.2f * pixel);
    Walk sunward;
    for (size_t i = 0; i < seen.t.size(); ++i) {
        const Vec3f d = seen.directions[i];
        const float toGround =
            options.ground && d.y < 0 && eye.y > bounds.lo.y ? (bounds.lo.y - eye.y) / d.y : INFINITY;
        if (seen.hit[i] && seen.t[i] < toGround)
            evaluations += forNormal;
        else if (toGround < 60 * size)
            seen.t[i] = toGround;
        else
            continue;
        evaluations += forOcclusion;
        sunward.add(seen.at(i), sunDirection());
    }
    evaluations += march(sunward, tape, box, 2e-3f * size, 2e-4f * size, 0);
    return static_cast<double>(evaluations) / static_cast<double>(std::max<size_t>(seen.t.size(), 1));
}

}  // namespace sgm::render
