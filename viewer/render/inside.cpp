// Where to stand inside a hollow: a coarse grid of the field says which empty places are enclosed and how deep they
// are, rays say where one can look far.
#include <algorithm>
#include <cmath>
#include <vector>

#include "modeler/core/conventions.h"
#include "viewer/render/camera.h"
#include "viewer/render/samples.h"

namespace sgm::render {
namespace {

/// Share of the 26 directions of the grid in which solid stands between cell (i, j, k) and the outside.
double enclosure(const Samples& grid, int i, int j, int k) {
    int walls = 0;
    for (int d = 0; d < 27; ++d) {
        const int dx = d % 3 - 1, dy = d / 3 % 3 - 1, dz = d / 9 - 1;
        if (d == 13) continue;
        for (int s = 1; grid.holds(i + s * dx, j + s * dy, k + s * dz); ++s)
            if (grid.values[grid.index(i + s * dx, j + s * dy, k + s * dz)] < 0) {
                ++walls;
                break;
            }
    }
    return walls / 26.0;
}

/// A place and which side of the surface it is on: 1 in the empty, −1 in the solid.
struct Stand {
    Vec3f place;
    float depth = 0;  ///< |f| there, metres
    float side = 1;
};

/// The best enclosed empty place: deep, and rather under a roof than in a pit, whose open sky leaves it 17 of the 26
/// directions; failing that, the deepest place in the solid.
Stand deepest(const Samples& grid) {
    Stand hollow, solid;
    double best = 0;
    solid.side = -1;
    solid.place = grid.bounds.centre();
    for (int k = 0; k < grid.count.z; ++k)
        for (int j = 0; j < grid.count.y; ++j)
            for (int i = 0; i < grid.count.x; ++i) {
                const float f = grid.values[grid.index(i, j, k)];
                if (-f > solid.depth) solid = {grid.at(i, j, k), -f, -1};
                if (!(f > 0.5f * grid.cell)) continue;
                const double enclosed = enclosure(grid, i, j, k), score = f * enclosed * enclosed;
                if (enclosed > 0.6 && score > best) {
                    best = score;
                    hollow = {grid.at(i, j, k), f, 1};
                }
            }
    return best > 0 ? hollow : solid;
}

constexpr float nearShare = 0.1f;  ///< of a grid's cell: so near to the surface a way meets it

/// How far one can go in a direction before meeting the surface, metres, or leaving the bounds.
struct Way {
    float length = 0;
    bool meets = false;
};

/// By direction. A way meets the surface where that is nearer than `near`, metres; `slope` is the field's steepest.
std::vector<Way> freeWays(const eval::Tape& tape, const Box3f& bounds, float near, float slope, const Stand& stand,
                          const std::vector<Vec3f>& directions) {
    constexpr int mostSteps = 256;  // beside a wall ways begin with short ones
    std::vector<Way> ways(directions.size());
    std::vector<bool> stopped(directions.size(), false);
    for (int step = 0; step < mostSteps && std::find(stopped.begin(), stopped.end(), false) != stopped.end(); ++step) {
        std::vector<Vec3f> points;
        for (size_t i = 0; i < directions.size(); ++i) points.push_back(stand.place + directions[i] * ways[i].length);
        const std::vector<float> values = valuesAt(tape, points);
        for (size_t i = 0; i < directions.size(); ++i) {
            if (stopped[i]) continue;
            const float free = stand.side * values[i] / slope;
            ways[i].meets = free < near;
            stopped[i] = ways[i].meets || !bounds.contains(points[i]);
            if (!stopped[i]) ways[i].length += free;
        }
    }
    return ways;
}

}  // namespace

Camera inside(const eval::Tape& tape, const Box3f& bounds) {
    const Samples grid = sample(tape, bounds);
    const Stand stand = deepest(grid);
    // Looking level or a little up or down, as a visitor does.
    std::vector<Vec3f> directions;
    for (int turn = 0; turn < 48; ++turn)
        for (const double rise : {0.0, -0.2, 0.2}) {
            const double angle = turn * pi / 24;
            directions.push_back(normalized(Vec3d{std::cos(angle), rise, std::sin(angle)}).as<float>());
        }
    const float slope = std::max(tape.lipschitz(), 1e-6f), near = nearShare * grid.cell;
    const std::vector<Way> ways = freeWays(tape, grid.bounds, near, slope, stand, directions);
    const auto longest = std::max_element(ways.begin(), ways.end(),
                                          [](const Way& one, const Way& other) { return one.length < other.length; });
    const Vec3f look = directions[static_cast<size_t>(longest - ways.begin())];
    // Step back from the deepest place, to see the hollow from its edge.
    const float back = freeWays(tape, grid.bounds, near, slope, stand, {-look}).front().length;
    const Vec3f eye = stand.place - look * std::max(0.0f, 0.6f * back - 0.2f * stand.depth);
    Camera camera;
    camera.eye = eye.as<double>();
    camera.at = (eye + look * std::max(longest->length, grid.cell)).as<double>();
    camera.fieldOfView = radians(70);
    camera.lamp_m = std::max(2.0f * stand.depth, 0.5f * (back + longest->length));
    return camera;
}

double lampFor(const eval::Tape& tape, const Box3f& bounds, Vec3d eyeAt) {
    constexpr int directionCount = 96;
    constexpr double leastClosed = 0.9;  // of the directions
    constexpr float steepest = 4;        // slope that is believed: a field that jumps says more
    const Vec3f eye = eyeAt.as<float>();
    if (!bounds.contains(eye)) return 0;
    const Stand stand{eye, valuesAt(tape, {eye})[0], 1};
    if (!(stand.depth > 0)) return 0;
    std::vector<Vec3f> directions;
    for (int i = 0; i < directionCount; ++i) {  // a spiral of equal areas
        const double y = 1 - (2.0 * i + 1) / directionCount, turn = i * pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - y * y);
        directions.push_back(Vec3d{r * std::cos(turn), y, r * std::sin(turn)}.as<float>());
    }
    const float cell = maxComponent(bounds.size()) / Samples::edge;
    const float slope = std::clamp(tape.lipschitz(), 1e-6f, steepest);
    // An eye beside a wall doesn't meet it on ways that lead along it or away.
    const float near = std::min(nearShare * cell, stand.depth / (4 * slope));
    const std::vector<Way> ways = freeWays(tape, bounds, near, slope, stand, directions);
    const auto closed = std::count_if(ways.begin(), ways.end(), [](const Way& way) { return way.meets; });
    if (static_cast<double>(closed) < leastClosed * directionCount) return 0;
    float longest = 2 * stand.depth;
    for (const Way& way : ways) longest = std::max(longest, way.length);
    return longest;
}

std::optional<double> surfaceBelow(const eval::Tape& tape, Vec3d from, double lowest_m) {
    constexpr double near_m = 1e-3, least_m = 1e-2;  // a wall beside the way makes no smaller steps
    constexpr int most = 256;
    double height_m = from.y;
    for (int i = 0; i < most && height_m > lowest_m; ++i) {
        const Vec3d at{from.x, height_m, from.z};
        const double free_m = static_cast<double>(valuesAt(tape, {at.as<float>()})[0]) /
                              std::max(static_cast<double>(tape.lipschitz()), 1e-6);
        if (free_m < near_m) return height_m - std::min(0.0, free_m);
        height_m -= std::max(free_m, least_m);
    }
    return std::nullopt;
}

}  // namespace sgm::render
