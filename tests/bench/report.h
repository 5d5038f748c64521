// Figures for people and for programs.
// Enters: measurements and limits. Leaves: lines of a table, or JSON. docs/lab/bench.md says what each means.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/bars.h"
#include "tests/bench/limits.h"
#include "tests/bench/measure.h"

namespace sgm::bench {

/// All of one run.
struct Measured {
    std::vector<Measurement> scenes;
    std::vector<DragResult> drags;
    std::vector<Bar> bars;
};

/// How many times longer polygonize took than its output needs at the measured bandwidth to fresh pages.
double polygonizeOverWrite(const Measurement& m, const Limits& limits);

std::string limitsLine(const Limits& limits, int threads);
std::string tableHeader();
std::string tableRow(const Measurement& m, const Limits& limits);
std::string dragLine(const DragResult& drag);
/// {"threads", "limits": {…}, "scenes": [{"scene", "resolution", "total_seconds", "dense_seconds", …}, …], "drags":
/// […], "bars": […]}
std::string toJson(const Measured& measured, const Limits& limits, int threads);

}  // namespace sgm::bench
