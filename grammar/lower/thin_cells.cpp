#include "grammar/lower/thin_cells.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/boxes.h"

namespace sgm::lower {
namespace {

constexpr double around = 1.5;  ///< in cells: from a scope to the middles of the cells around it

/// The cells of a grid that the box around a part meets, first and last along each axis.
struct CellsOfBox {
    Vec3i first, last;

    CellsOfBox(const derive::Scope& scope, const mesh::Grid& grid) {
        const auto cell = static_cast<double>(grid.cell_m);
        const Box3d box = derive::boxOf(scope).inflated(around * cell);
        for (int axis = 0; axis < 3; ++axis) {
            const auto clamped = [&](double at) {
                return static_cast<int>(std::clamp(std::floor((at - static_cast<double>(grid.origin[axis])) / cell),
                                                   0.0, static_cast<double>(grid.cells[axis] - 1)));
            };
            first[axis] = clamped(box.lo[axis]), last[axis] = clamped(box.hi[axis]);
        }
    }
};

void addCellsAround(const derive::Scope& scope, const mesh::Grid& grid, mesh::CellSet& cells) {
    const double cell = static_cast<double>(grid.cell_m), reach_m = around * cell;
    const CellsOfBox box(scope, grid);
    const Vec3d origin = grid.origin.as<double>(), half = scope.half();
    const Mat3 local = scope.axes.transposed();
    for (int z = box.first.z; z <= box.last.z; ++z)
        for (int y = box.first.y; y <= box.last.y; ++y)
            for (int x = box.first.x; x <= box.last.x; ++x) {
                const Vec3d middle = origin + Vec3d{x + 0.5, y + 0.5, z + 0.5} * cell;
                const Vec3d p = local * (middle - scope.centre);
                const Vec3d beyond = max(Vec3d{std::abs(p.x), std::abs(p.y), std::abs(p.z)} - half, Vec3d{});
                if (dot(beyond, beyond) <= reach_m * reach_m) cells.insert({x, y, z});
            }
}

}  // namespace

int halvingsFor(const ThinPart& part, float cell_m) {
    int halvings = 0;
    while (std::ldexp(static_cast<double>(cell_m), -halvings) > part.cell_m) ++halvings;
    return halvings;
}

double countCellsAround(const ThinPart& part, const mesh::Grid& grid) {
    double count = 0;
    for (const derive::Scope& place : part.places) {
        const CellsOfBox cells(place, grid);
        const Vec3d along = (cells.last - cells.first + Vec3i{1, 1, 1}).as<double>();
        count += along.x * along.y * along.z;
    }
    return count;
}

void addCellsAround(const ThinPart& part, const mesh::Grid& grid, mesh::CellSet& cells) {
    for (const derive::Scope& place : part.places) addCellsAround(place, grid, cells);
}

}  // namespace sgm::lower
