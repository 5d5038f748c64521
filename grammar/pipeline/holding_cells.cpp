#include "grammar/pipeline/holding_cells.h"

#include <algorithm>
#include <cmath>

#include "grammar/lower/thin_cells.h"
#include "grammar/pipeline/triangles_of_cells.h"

namespace sgm::pipeline {
namespace {

constexpr double halvedShare = 0.6;  ///< of the triangles that a mesh may have: of halved cells, the rest of others

}  // namespace

HoldingCells::HoldingCells(float cell_m, const std::vector<lower::ThinPart>& missing)
    : cell_m_(static_cast<double>(cell_m)), missing_(missing) {
    for (const lower::ThinPart& part : missing)
        mostTriangles_ = std::max(mostTriangles_, halvedShare * static_cast<double>(part.mostTriangles));
}

double HoldingCells::before(double least_m, int halvings) const {
    for (; halvings > 0; --halvings) {
        const double whole_m = std::ldexp(least_m, halvings);
        if (whole_m >= cell_m_) continue;
        // Cells that are halved once have no more than four times as many triangles as before, which is always allowed.
        if (halvings == 1 || trianglesAt(whole_m) <= mostTriangles_) return whole_m;
    }
    return least_m < cell_m_ ? least_m : 0.5 * cell_m_;
}

double HoldingCells::trianglesAt(double cell_m) const {
    double triangles = 0;
    for (const lower::ThinPart& part : missing_) {
        const int needed = lower::halvingsFor(part, static_cast<float>(cell_m));
        triangles += trianglesOfPart(part, std::ldexp(cell_m, -std::min(needed, part.halvings)));
    }
    return triangles;
}

}  // namespace sgm::pipeline
