// Where to stand inside a hollow: a coarse grid of the field says which empty places are enclosed and how deep they
// are, rays say where one can look far.
#include <array>
#include <cmath>
#include <vector>

#include "modeler/core/conventions.h"
#include "modeler/eval/evaluate.h"
#include "viewer/offscreen.h"

namespace sgm::viewer {
namespace {

constexpr int gridEdge = 40;  // samples along the longest side

/// Field values at the centres of a grid's cells.
struct Samples {
    Box3f bounds;
    Vec3i count;
    float cell = 1;  ///< metres
    std::vector<float> values;

    Vec3f at(int i, int j, int k) const {
        return bounds.lo + Vec3f{float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f} * cell;
    }
    size_t index(int i, int j, int k) const {
        return (size_t(k) * size_t(count.y) + size_t(j)) * size_t(count.x) + size_t(i);
    }
    bool holds(int i, int j, int k) const {
        return i >= 0 && j >= 0 && k >= 0 && i < count.x && j < count.y && k < count.z;
    }
};

std::vector<float> valuesAt(const eval::Tape& tape, const std::vector<Vec3f>& points) {
    std::vector<float> x, y, z, values(points.size());
    for (const Vec3f& p : points) {
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
    }
    eval::Workspace workspace;
    eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    return values;
}

Samples sample(const eval::Tape& tape, const Box3f& bounds) {
    Samples grid;
    grid.bounds = bounds;
    grid.cell = maxComponent(bounds.size()) / gridEdge;
    for (int axis = 0; axis < 3; ++axis)
        grid.count[axis] = std::max(1, static_cast<int>(bounds.size()[axis] / grid.cell));
    std::vector<Vec3f> points;
    for (int k = 0; k < grid.count.z; ++k)
        for (int j = 0; j < grid.count.y; ++j)
            for (int i = 0; i < grid.count.x; ++i) points.push_back(grid.at(i, j, k));
    grid.values = valuesAt(tape, points);
    return grid;
}

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

/// The deepest enclosed empty place; failing that, the deepest place in the solid.
Stand deepest(const Samples& grid) {
    Stand hollow, solid;
    solid.side = -1;
    solid.place = grid.bounds.centre();
    for (int k = 0; k < grid.count.z; ++k)
        for (int j = 0; j < grid.count.y; ++j)
            for (int i = 0; i < grid.count.x; ++i) {
                const float f = grid.values[grid.index(i, j, k)];
                if (-f > solid.depth) solid = {grid.at(i, j, k), -f, -1};
                if (f > hollow.depth && enclosure(grid, i, j, k) > 0.72) hollow = {grid.at(i, j, k), f, 1};
            }
    return hollow.depth > grid.cell ? hollow : solid;
}

/// How far one can go from the stand in each direction before meeting the surface or leaving the bounds, metres.
std::vector<float> freeDistances(const eval::Tape& tape, const Samples& grid, const Stand& stand,
                                 const std::vector<Vec3f>& directions) {
    std::vector<float> distances(directions.size(), 0.0f);
    std::vector<bool> stopped(directions.size(), false);
    for (int step = 0; step < 64; ++step) {
        std::vector<Vec3f> points;
        for (size_t i = 0; i < directions.size(); ++i) points.push_back(stand.place + directions[i] * distances[i]);
        const std::vector<float> values = valuesAt(tape, points);
        for (size_t i = 0; i < directions.size(); ++i) {
            const float free = stand.side * values[i] / std::max(tape.lipschitz(), 1e-6f);
            stopped[i] = stopped[i] || free < 0.1f * grid.cell || !grid.bounds.contains(points[i]);
            if (!stopped[i]) distances[i] += free;
        }
    }
    return distances;
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
    const std::vector<float> distances = freeDistances(tape, grid, stand, directions);
    const size_t best = static_cast<size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin());
    const Vec3f look = directions[best];
    // Step back from the deepest place, to see the hollow from its edge.
    const float back = freeDistances(tape, grid, stand, {-look}).front();
    const Vec3f eye = stand.place - look * std::max(0.0f, 0.6f * back - 0.2f * stand.depth);
    Camera camera;
    camera.eye = eye.as<double>();
    camera.at = (eye + look * std::max(distances[best], grid.cell)).as<double>();
    camera.fieldOfView = radians(70);
    camera.lamp_m = std::max(2.0f * stand.depth, 0.5f * (back + distances[best]));
    return camera;
}

}  // namespace sgm::viewer
