#include "viewer/samples.h"

#include <cmath>

#include "modeler/eval/evaluate.h"
#include "viewer/offscreen.h"

namespace sgm::viewer {

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
    grid.cell = maxComponent(bounds.size()) / Samples::edge;
    for (int axis = 0; axis < 3; ++axis)
        grid.count[axis] = std::max(1, static_cast<int>(std::ceil(bounds.size()[axis] / grid.cell - 1e-3f)));
    std::vector<Vec3f> points;
    for (int k = 0; k < grid.count.z; ++k)
        for (int j = 0; j < grid.count.y; ++j)
            for (int i = 0; i < grid.count.x; ++i) points.push_back(grid.at(i, j, k));
    grid.values = valuesAt(tape, points);
    return grid;
}

std::vector<Vec3f> Samples::placesBelow(float below) const {
    std::vector<Vec3f> places;
    for (int k = 0; k < count.z; ++k)
        for (int j = 0; j < count.y; ++j)
            for (int i = 0; i < count.x; ++i)
                if (values[index(i, j, k)] < below) places.push_back(at(i, j, k));
    return places;
}

Box3f tighten(const eval::Tape& tape, const Box3f& bounds) {
    if (bounds.empty() || !bounds.finite() || !(maxComponent(bounds.size()) > 0)) return bounds;
    const Samples grid = sample(tape, bounds);
    // No surface is in a cell whose centre is farther from it than the corners are.
    const float reach = grid.cell * 0.867f;
    Box3f tight;
    for (const Vec3f& place : grid.placesBelow(reach * tape.lipschitz()))
        tight = hull(tight, Box3f{place, place}.inflated(grid.cell / 2));
    return tight.empty() ? bounds : intersection(tight, bounds);
}

}  // namespace sgm::viewer
