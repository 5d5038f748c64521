#include "modeler/mesh/region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "modeler/field/ops.h"

namespace sgm::mesh {

bool isExpensive(const eval::Tape& tape) {
    constexpr uint32_t manySteps = 8;
    return std::any_of(tape.code().begin(), tape.code().end(), [](const eval::Instruction& in) {
        const field::OpTraits& row = field::traits(in.op);
        return row.foldSteps && row.foldSteps(in.data) >= manySteps;
    });
}

namespace {

/// Lipschitz constant · cell, rounded up to a power of two; infinite where nothing is known.
float reachOfCell(const eval::Tape& tape, const Grid& grid) {
    const float lipschitz = tape.lipschitz();
    if (!(lipschitz > 0) || !std::isfinite(lipschitz)) return std::numeric_limits<float>::infinity();
    int exponent = 0;
    const bool isPower = std::frexp(lipschitz, &exponent) == 0.5f;
    return std::ldexp(grid.cell_m, isPower ? exponent - 1 : exponent);
}

constexpr float farCells = 1.25f;

}  // namespace

eval::RelevantRange relevantRangeFor(const eval::Tape& tape, const Grid& grid) {
    const float reach = reachOfCell(tape, grid);
    if (!std::isfinite(reach)) return {};
    const float most = (isExpensive(tape) ? farMiddle : farCells) * reach;
    return {-most, most};
}

float surfaceReach(const eval::Tape& tape, const Grid& grid) {
    return std::min(0.999f * farCells * reachOfCell(tape, grid), std::numeric_limits<float>::max());
}

}  // namespace sgm::mesh
