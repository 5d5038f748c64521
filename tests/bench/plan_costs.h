// What the plan of a city costs: roads, blocks and lots over maps that are formulas.
// Enters: a size. Leaves: processor time of every stage and memory. Assumes one thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/town/lots.h"
#include "tests/bench/bars.h"

namespace sgm::bench {

struct PlanCase {
    std::string name;
    double side_m = 5000;
    town::Cuts cuts = town::Cuts::Boxes;
};

struct PlanCosts {
    PlanCase what;
    size_t roads = 0, blocks = 0, lots = 0;
    double roads_s = 0, blocks_s = 0, lots_s = 0;  ///< processor time
    double bytesPerLot = 0;                        ///< of roads and lots as they are kept, one line a lot
};

/// Processor time from a parameter's value to the plan of a town, its maps and language included: what a slider in the
/// window waits for. Error::Input where the grammar can't be read.
Result<double> measureSlider(const std::filesystem::path& town);

std::vector<PlanCase> planCases();
PlanCosts measurePlan(const PlanCase& what);
std::string planHeader();
std::string planLine(const PlanCosts& costs);
std::vector<Bar> judge(const std::vector<PlanCosts>& costs);

}  // namespace sgm::bench
