#include "grammar/pipeline/grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "grammar/derive/scope_footprint.h"

namespace sgm::pipeline {
namespace {

constexpr int bins = 1024;        ///< of a cell
constexpr int reach = bins / 50;  ///< a plane this near to samples counts, the more the nearer
constexpr int mostShift = bins / 5, shiftStep = bins / 64;
/// Where the grid lies if nothing speaks against it, in bins: simple fractions of a cell from the middle of the bounds
/// are far from samples then, and so are the diagonals through them.
constexpr int usualShift[] = {56, 87, 150};

struct Plane {
    double at_m = 0;
    double rim_m = 0;  ///< length of the creases in it
};

/// What the planes of a model across an axis cost by where the samples of a grid lie: metres of creases in
/// planes near samples, and beside gaps that hold no sample.
class SampleCosts {
public:
    SampleCosts(std::vector<Plane> planes, double origin_m, double cell_m) {
        const auto inCells = [&](const Plane& plane) { return (plane.at_m - origin_m) / cell_m; };
        std::erase_if(planes, [&](const Plane& plane) { return !std::isfinite(inCells(plane)); });
        std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.at_m < b.at_m; });
        merge(planes, same * cell_m);
        for (size_t i = 0; i < planes.size(); ++i) {
            planes_[binOf(inCells(planes[i]))] += planes[i].rim_m;
            if (i) addGap(inCells(planes[i - 1]), inCells(planes[i]), std::min(planes[i - 1].rim_m, planes[i].rim_m));
        }
        std::partial_sum(passed_.begin(), passed_.end(), passed_.begin());
    }

    /// The shift, in bins, that costs least; of equal ones the nearest to the usual one.
    int bestShift(int usual) const {
        int best = usual;
        double least = costOf(usual);
        for (int step = 1; step * shiftStep <= 2 * mostShift && least > 0; ++step)
            for (const int shift : {usual + step * shiftStep, usual - step * shiftStep}) {
                if (std::abs(shift) > mostShift) continue;
                if (const double cost = costOf(shift); cost < least) least = cost, best = shift;
            }
        return best;
    }

private:
    static constexpr double same = 1e-3;  ///< planes this near to each other, in cells, are one

    static void merge(std::vector<Plane>& sorted, double near_m) {
        size_t kept = 0;
        for (const Plane& plane : sorted)
            if (kept && plane.at_m - sorted[kept - 1].at_m <= near_m)
                sorted[kept - 1].rim_m += plane.rim_m;
            else
                sorted[kept++] = plane;
        sorted.resize(kept);
    }
    static size_t binOf(double at) { return static_cast<size_t>((at - std::floor(at)) * bins) % bins; }

    void addGap(double from, double to, double rim_m) {
        if (to - from >= 1) return;
        const size_t first = binOf(from), end = binOf(to);
        if (first <= end) passed_[0] += rim_m;  // else the gap holds the samples of the first bin
        passed_[first] -= rim_m;
        passed_[end] += rim_m;
    }

    double costOf(int shift) const {
        double near = 0;
        for (int away = -reach; away <= reach; ++away)
            near += planes_[static_cast<size_t>((shift + away + bins) % bins)] * (reach + 1 - std::abs(away));
        return near / reach + passed_[static_cast<size_t>((shift + bins) % bins)];
    }

    std::array<double, bins> planes_{};  ///< rims by where in a cell
    std::array<double, bins> passed_{};  ///< of the gaps that samples there pass by
};

using Planes = std::array<std::vector<Plane>, 3>;  ///< by the axis they lie across

/// The axis of the world along which a direction lies, or -1.
int axisAlong(Vec3d direction) {
    constexpr double along = 1 - 1e-9;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) > along) return axis;
    return -1;
}

void addSides(Planes& planes, const derive::Scope& scope, int axis, double rim_m) {
    Vec3d unit;
    unit[axis] = 1;
    const int along = axisAlong(scope.axes * unit);
    if (along < 0) return;
    for (const double side : {-1.0, 1.0})
        planes[static_cast<size_t>(along)].push_back({scope.centre[along] + side * scope.half()[axis], rim_m});
}

void addBox(Planes& planes, const derive::Scope& scope) {
    for (int axis = 0; axis < 3; ++axis)
        addSides(planes, scope, axis, 2 * (scope.size[(axis + 1) % 3] + scope.size[(axis + 2) % 3]));
}

void addFootprint(Planes& planes, const derive::Scope& scope, const derive::Footprints& footprints) {
    double rim_m = 0;
    for (const plan::PlacedEdge& edge : plan::edgesOf(footprintOf(scope, footprints))) {
        rim_m += edge.length();
        const plan::Vec2 out = edge.normal();
        const int along = axisAlong(scope.axes * Vec3d{out.x, 0, out.z});
        if (along < 0) continue;
        const Vec3d point = scope.centre + scope.axes * Vec3d{edge.from.x, 0, edge.from.z};
        planes[static_cast<size_t>(along)].push_back({point[along], 2 * (edge.length() + scope.size.y)});
    }
    addSides(planes, scope, 1, rim_m);
}

/// The planes of a derivation's solids that lie across an axis.
Planes planesOf(const derive::Derivation& derivation) {
    Planes planes;
    for (const derive::Shape& shape : derivation.tree.shapes) {
        if (shape.solid == derive::none) continue;
        shape.scope.footprint == derive::none ? addBox(planes, shape.scope)
                                              : addFootprint(planes, shape.scope, derivation.tree.footprints);
    }
    return planes;
}

}  // namespace

mesh::Grid moveOffPlanes(mesh::Grid grid, const derive::Derivation& derivation) {
    Planes planes = planesOf(derivation);
    for (int axis = 0; axis < 3; ++axis) {
        const SampleCosts costs(std::move(planes[static_cast<size_t>(axis)]), static_cast<double>(grid.origin[axis]),
                                static_cast<double>(grid.cell_m));
        const int shift = costs.bestShift(usualShift[axis]);
        grid.origin[axis] += grid.cell_m * static_cast<float>(shift) / static_cast<float>(bins);
    }
    return grid;
}

double withTwoDigits(double value) {
    const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
    return std::floor(value / unit + 1e-9) * unit;
}

std::string optionForCells(const Box3f& bounds, double cell_m) {
    const double count = std::ceil(static_cast<double>(maxComponent(bounds.size())) / cell_m);
    return count <= mostResolution ? fmt::format("--resolution {:.0f}", count)
                                   : fmt::format("--cell {:g}", withTwoDigits(cell_m));
}

mesh::Grid gridOver(const Box3f& bounds, const CellSize& size) {
    return mesh::gridFor(bounds,
                         size.cell_m > 0 ? static_cast<float>(size.cell_m) : mesh::cellFor(bounds, size.resolution));
}

mesh::Grid gridOver(const Model& model, const CellSize& size, mesh::Surface surface) {
    const mesh::Grid grid = gridOver(model.lowered->field.bounds, size);
    return surface == mesh::Surface::Crisp ? moveOffPlanes(grid, model.derivation) : grid;
}

mesh::Grid gridToKeep(const mesh::Grid& previous, const Box3f& bounds, float cell_m,
                      const derive::Derivation& derivation, mesh::Surface surface) {
    const mesh::Grid grid = mesh::gridToKeep(previous, bounds, cell_m);
    const bool isKept =
        grid.origin == previous.origin && grid.cell_m == previous.cell_m && grid.cells == previous.cells;
    return isKept || surface != mesh::Surface::Crisp ? grid : moveOffPlanes(grid, derivation);
}

mesh::Grid gridOf(const Model& model, int cells) {
    return gridOver(model, {.resolution = cells}, mesh::Surface::Crisp);
}

}  // namespace sgm::pipeline
