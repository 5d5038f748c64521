// The planes of a roof over the edges of a footprint, for what asks where they meet.
// Enters: a roof of the primitive table, its footprint and numbers. Leaves: planes as leaves of the footprint's
// formula. Assumes that arguments stand as solids_plan.cpp reads them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "modeler/field/plan_solids.h"

namespace sgm::field {

/// A roof of one plane over every edge.
struct RoofPlanes {
    /// What rises over one edge.
    struct Side {
        double slope = 0;  ///< tangent of its pitch; 0: a gable
        double rise = 0;   ///< metres above the others at which it begins
    };
    std::vector<Side> sides;  ///< by edge
    double overhang_m = 0, fascia_m = 0;
    double highest_m = 1e9;  ///< where broken slopes end
};

/// The planes of a row; nothing for roofs that aren't made of them.
std::optional<RoofPlanes> roofPlanes(const Primitive& row, const plan::Footprint& footprint,
                                     const plan::Formula& formula, std::span<const Argument> arguments);

/// The slopes of a roof, as heights negated, and its outline, both as leaves of the footprint's formula. Assumes that
/// the formula outlives it.
struct RoofSurface {
    const plan::Formula& formula;
    std::vector<plan::Linear> slopes, outline;
};
RoofSurface surfaceOf(const RoofPlanes& planes, const plan::Footprint& footprint, const plan::Formula& formula);

}  // namespace sgm::field
