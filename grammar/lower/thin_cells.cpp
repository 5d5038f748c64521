#include "grammar/lower/thin_cells.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/boxes.h"

namespace sgm::lower {
namespace {

constexpr double around = 1.5;  ///< in cells: from a scope to the middles of the cells around it

}  // namespace

int halvingsFor(const ThinPart& part, float cell_m) {
    int halvings = 0;
    while (std::ldexp(static_cast<double>(cell_m), -halvings) > part.cell_m) ++halvings;
    return halvings;
}

double countCellsAround(const ThinPart& part, const mesh::Grid& grid) {
    const Vec3d size = derive::boxOf(part.scope).size();
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) count *= size[axis] / static_cast<double>(grid.cell_m) + 2 * around + 1;
    return count;
}

void addCellsAround(const ThinPart& part, const mesh::Grid& grid, mesh::CellSet& cells) {
    const derive::Scope& scope = part.scope;
    const double cell = static_cast<double>(grid.cell_m), reach_m = around * cell;
    const Box3d box = derive::boxOf(scope).inflated(reach_m);
    const Vec3d origin = grid.origin.as<double>(), half = scope.half();
    const auto clamped = [&](Vec3d p, int axis) {
        return static_cast<int>(
            std::clamp(std::floor((p[axis] - origin[axis]) / cell), 0.0, static_cast<double>(grid.cells[axis] - 1)));
    };
    const Vec3i first{clamped(box.lo, 0), clamped(box.lo, 1), clamped(box.lo, 2)};
    const Vec3i last{clamped(box.hi, 0), clamped(box.hi, 1), clamped(box.hi, 2)};
    const Mat3 local = scope.axes.transposed();
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const Vec3d middle = origin + Vec3d{x + 0.5, y + 0.5, z + 0.5} * cell;
                const Vec3d p = local * (middle - scope.centre);
                const Vec3d beyond = max(Vec3d{std::abs(p.x), std::abs(p.y), std::abs(p.z)} - half, Vec3d{});
                if (dot(beyond, beyond) <= reach_m * reach_m) cells.insert({x, y, z});
            }
}

}  // namespace sgm::lower
