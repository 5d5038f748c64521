#include "grammar/pipeline/holding_cells.h"

#include <algorithm>
#include <cmath>

#include "grammar/lower/thin_cells.h"

namespace sgm::pipeline {
namespace {

constexpr double mostTriangles = 600000;  ///< of halved cells; a mesh may have 1,000,000, with those that aren't halved
constexpr double cellsPerArea = 1.5;      ///< that a slanted plate meets, where it meets one along the grid

/// Of a part from one side.
double areaOf(const lower::ThinPart& part) {
    double area_m2 = 0;
    for (const derive::Scope& place : part.places)
        area_m2 += place.size.x * place.size.y * place.size.z / minComponent(place.size);
    return area_m2;
}

}  // namespace

HoldingCells::HoldingCells(float cell_m, const std::vector<lower::ThinPart>& missing)
    : cell_m_(static_cast<double>(cell_m)), missing_(missing) {
    for (const lower::ThinPart& part : missing) areas_m2_.push_back(areaOf(part));
}

double HoldingCells::before(double least_m, int halvings) const {
    for (; halvings > 0; --halvings) {
        const double whole_m = std::ldexp(least_m, halvings);
        if (whole_m >= cell_m_) continue;
        // Cells that are halved once have no more than four times as many triangles as before, which is always allowed.
        if (halvings == 1 || trianglesAt(whole_m) <= mostTriangles) return whole_m;
    }
    return least_m < cell_m_ ? least_m : 0.5 * cell_m_;
}

double HoldingCells::trianglesAt(double cell_m) const {
    double triangles = 0;
    for (size_t i = 0; i < missing_.size(); ++i) {
        const int needed = lower::halvingsFor(missing_[i], static_cast<float>(cell_m));
        const double finest_m = std::ldexp(cell_m, -std::min(needed, missing_[i].halvings));
        triangles += 2 * cellsPerArea * areas_m2_[i] / (finest_m * finest_m);
    }
    return triangles;
}

}  // namespace sgm::pipeline
