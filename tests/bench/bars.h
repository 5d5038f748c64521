// What the project asks of itself, beside what was measured.
// Enters: measurements of one run. Leaves: a line a bar. Assumes nothing: what wasn't measured is said so.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/drag.h"
#include "tests/bench/limits.h"
#include "tests/bench/measure.h"

namespace sgm::bench {

/// One thing asked for.
struct Bar {
    std::string what;
    double aim = 0;
    bool atLeast = false;  ///< else at most
    double measured = 0;   ///< 0: not measured in this run
    std::string remark;

    bool reached() const { return measured > 0 && (atLeast ? measured >= aim : measured <= aim); }
};

std::vector<Bar> judge(const std::vector<Measurement>& measurements, const std::vector<DragResult>& drags,
                       const Limits& limits);
/// "reached", "short" or "–", and the figures.
std::string barLine(const Bar& bar);

}  // namespace sgm::bench
