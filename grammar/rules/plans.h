// Plans by name: what `footprint ell(…)` and its like draw.
// Enters: names. Leaves: rows. Assumes that a row checks its numbers itself (modeler/plan/shapes.h).
#pragma once

#include <span>
#include <string_view>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::rules {

enum class PlanParameterKind : uint8_t { Length, Angle, Count };

struct PlanParameter {
    std::string_view name;
    PlanParameterKind kind;
    double fallback;  ///< metres, radians or a number
    std::string_view doc;
    bool required = true;
};

/// One row: a plan and its numbers.
struct PlanRow {
    std::string_view name;
    std::string_view doc;
    std::string_view example;
    std::span<const PlanParameter> parameters;
    /// Metres, centred on its bounding box; Error::Input names the parameter at fault.
    Result<plan::Footprint> (*draw)(std::span<const double> numbers);
    /// The parameter that, when 0, lets the plan fill the scope; none: −1.
    int fillsWithout = -1;
};

/// The table, in the order of the reference page.
std::span<const PlanRow> planRows();
/// The row called `name`, or null.
const PlanRow* findPlan(std::string_view name);

}  // namespace sgm::rules
