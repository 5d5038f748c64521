// Figures for people and for programs.
// Enters: measurements and limits. Leaves: lines of a table, or JSON. docs/performance.md says what each means.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/limits.h"
#include "tests/bench/measure.h"

namespace sgm::bench {

std::string limitsLine(const Limits& limits, int threads);
std::string tableHeader();
std::string tableRow(const Measurement& m, const Limits& limits);
/// {"threads", "limits": {…}, "scenes": [{"scene", "resolution", "total_seconds", "dense_seconds", …}, …]}
std::string toJson(const std::vector<Measurement>& measurements, const Limits& limits, int threads);

}  // namespace sgm::bench
