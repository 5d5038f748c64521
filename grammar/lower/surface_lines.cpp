#include "grammar/lower/surface_lines.h"

#include <algorithm>
#include <cmath>

#include "grammar/lower/scope_lines.h"

namespace sgm::lower {
namespace {

constexpr int fewestAlong = 4;      ///< lines along an axis
constexpr int mostSteps = 400;      ///< on a line
constexpr float stepShare = 0.9f;   ///< of how far the surface is at least
constexpr double leastStep = 0.06;  ///< of a cell, or of the line where that is shorter
constexpr int halvings = 8;         ///< of a step around a crossing

}  // namespace

double SurfaceLines::find(const derive::Scope& scope, OriginId part, const Density& density, const eval::Tape& tape,
                          eval::Workspace& workspace) {
    const double spacing_m = listLines(scope, density.mostAlong);
    followLines(tape, workspace);
    return spacing_m * keepOwn(part, tape, workspace, density.mostPoints);
}

double SurfaceLines::findOnFaces(const derive::Scope& scope, OriginId part, const Density& density,
                                 const eval::Tape& tape, eval::Workspace& workspace) {
    const double spacing_m = listLines(scope, density.mostAlong);
    probeFaces(tape, workspace);
    return spacing_m * keepOwn(part, tape, workspace, density.mostPoints);
}

void SurfaceLines::findOnLines(std::span<const Line> lines, OriginId part, const eval::Tape& tape,
                               eval::Workspace& workspace) {
    rays_.clear();
    for (size_t i = 0; i < lines.size(); ++i) addLine(lines[i], i);
    followLines(tape, workspace);
    keepOwn(part, tape, workspace, std::max<size_t>(found_.size(), 1));
}

void SurfaceLines::evaluate(const eval::Tape& tape, eval::Workspace& workspace) {
    values_.resize(points_.size());
    eval::evaluate(tape, points_.points(), values_.data(), workspace);
}

/// Lines along the scope's axes, as far as they lie in the bounds. Returns how far apart they are at most.
double SurfaceLines::listLines(const derive::Scope& scope, int mostAlong) {
    rays_.clear();
    double spacing_m = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto count = [&](int across) {
            return static_cast<int>(std::clamp(std::ceil(scope.size[across] / cell_m_), double{fewestAlong},
                                               static_cast<double>(mostAlong)));
        };
        const int alongU = count(u), alongV = count(v);
        spacing_m = std::max({spacing_m, scope.size[u] / alongU, scope.size[v] / alongV});
        for (int j = 0; j < alongV; ++j)
            for (int i = 0; i < alongU; ++i) {
                Vec3d share{};
                // Off the middle, so that no line lies in a plane of symmetry.
                share[u] = 2 * (i + 0.535) / alongU - 1, share[v] = 2 * (j + 0.535) / alongV - 1;
                share[axis] = -lineReach;
                addLine({scope.point(share), scope.axes * alongAxis(axis), scope.size[axis]});
            }
    }
    return spacing_m;
}

/// Clips a line through a scope of such a size to the bounds.
void SurfaceLines::addLine(const Line& line, size_t number) {
    const auto& [from, along, size_m] = line;
    double begin = 0, end = size_m * lineReach;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(bounds_.lo[axis]) - cell_m_ - from[axis],
                     high = static_cast<double>(bounds_.hi[axis]) + cell_m_ - from[axis];
        if (std::abs(along[axis]) < 1e-9) {
            if (low > 0 || high < 0) return;
            continue;
        }
        const double toLow = low / along[axis], toHigh = high / along[axis];
        begin = std::max(begin, std::min(toLow, toHigh)), end = std::min(end, std::max(toLow, toHigh));
    }
    if (begin < end)
        rays_.push_back({from,
                         along,
                         begin,
                         end,
                         leastStep * std::min(cell_m_, size_m),
                         {size_m * (lineReach - 1) / 2, size_m * (lineReach + 1) / 2},
                         number,
                         0});
}

/// Leaves in `found_` where lines cross the field's surface: each step is about as long as the field says.
void SurfaceLines::followLines(const eval::Tape& tape, eval::Workspace& workspace) {
    found_.clear();
    const auto placeAll = [&] {
        points_.clear();
        for (const Ray& ray : rays_) points_.add(ray.place().as<float>());
        evaluate(tape, workspace);
    };
    const float share = stepShare / eval::believedSlope(tape);
    placeAll();
    for (size_t i = 0; i < rays_.size(); ++i) rays_[i].value = values_[i];
    for (int step = 0; step < mostSteps && !rays_.empty(); ++step) {
        std::vector<Vec3d> before;
        for (Ray& ray : rays_) {
            before.push_back(ray.place());
            const auto far_m = static_cast<double>(share * std::abs(ray.value));
            ray.at_m = std::min(ray.at_m + std::max(far_m, ray.leastStep_m), ray.end_m);
        }
        placeAll();
        size_t kept = 0;
        for (size_t i = 0; i < rays_.size(); ++i) {
            Ray ray = rays_[i];
            if ((ray.value < 0) != (values_[i] < 0)) found_.push_back({before[i], ray.place(), ray.line});
            ray.value = values_[i];
            if (ray.at_m < ray.end_m) rays_[kept++] = ray;
        }
        rays_.resize(kept);
    }
    halve(found_, tape, workspace);
}

/// Leaves in `found_` where lines cross the field's surface on the scope's faces.
void SurfaceLines::probeFaces(const eval::Tape& tape, eval::Workspace& workspace) {
    found_.clear(), points_.clear();
    for (const Ray& ray : rays_)
        for (const double at_m : ray.faces_m) {
            if (at_m < ray.at_m || at_m > ray.end_m) continue;
            const double half_m = 0.5 * leastStep * cell_m_;
            found_.push_back({ray.from + ray.along * (at_m - half_m), ray.from + ray.along * (at_m + half_m)});
            points_.add(found_.back().from.as<float>()), points_.add(found_.back().to.as<float>());
        }
    evaluate(tape, workspace);
    size_t kept = 0;
    for (size_t i = 0; i < found_.size(); ++i)
        if ((values_[2 * i] < 0) != (values_[2 * i + 1] < 0)) found_[kept++] = found_[i];
    found_.resize(kept);
}

/// Halves the steps around crossings.
void SurfaceLines::halve(std::vector<Bracket>& brackets, const eval::Tape& tape, eval::Workspace& workspace) {
    points_.clear();
    for (const Bracket& b : brackets) points_.add(b.from.as<float>());
    evaluate(tape, workspace);
    const std::vector<float> atStart = values_;
    for (int halving = 0; halving < halvings; ++halving) {
        points_.clear();
        for (const Bracket& b : brackets) points_.add(b.middle().as<float>());
        evaluate(tape, workspace);
        for (size_t i = 0; i < brackets.size(); ++i)
            ((atStart[i] < 0) == (values_[i] < 0) ? brackets[i].from : brackets[i].to) = brackets[i].middle();
    }
}

/// Keeps what is the part's own surface, not too much of it. Returns how much farther apart that is than the lines.
double SurfaceLines::keepOwn(OriginId part, const eval::Tape& tape, eval::Workspace& workspace, size_t mostPoints) {
    points_.clear();
    for (const Bracket& b : found_) points_.add(b.middle().as<float>());
    const std::vector<OriginId>& owners = owners_.at(points_, tape, workspace);
    size_t own = 0;
    for (size_t i = 0; i < found_.size(); ++i)
        if (owners[i] == part) found_[own++] = found_[i];
    const size_t stride = std::max<size_t>((own + mostPoints - 1) / mostPoints, 1);
    size_t kept = 0;
    for (size_t i = 0; i < own; i += stride) found_[kept++] = found_[i];
    found_.resize(kept);
    return std::sqrt(static_cast<double>(stride));
}

}  // namespace sgm::lower
