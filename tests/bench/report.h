// Figures for people and for programs.
// Enters: measurements and limits. Leaves: lines of a table, or JSON. docs/performance.md says what each means.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/bars.h"
#include "tests/bench/limits.h"
#include "tests/bench/measure.h"

namespace sgm::bench {

/// How many times longer polygonize took than its output needs at the measured bandwidth to fresh pages.
double polygonizeOverWrite(const Measurement& m, const Limits& limits);

std::string limitsLine(const Limits& limits, int threads);
std::string tableHeader();
std::string tableRow(const Measurement& m, const Limits& limits);
/// {"threads", "limits": {…}, "scenes": [{"scene", "resolution", "total_seconds", "dense_seconds", …}, …], "bars": […]}
std::string toJson(const std::vector<Measurement>& measurements, const std::vector<Bar>& bars, const Limits& limits,
                   int threads);

}  // namespace sgm::bench
