// Time on two clocks: the wall's, and the processor's for this thread alone, which other programs don't disturb.
#pragma once

#include <ctime>

#include "modeler/core/stopwatch.h"

namespace sgm::viewer {

/// Seconds on both clocks.
struct Spent {
    double wall = 0, processor = 0;
    Spent& operator+=(const Spent& o) {
        wall += o.wall;
        processor += o.processor;
        return *this;
    }
    friend Spent operator-(const Spent& a, const Spent& b) { return {a.wall - b.wall, a.processor - b.processor}; }
};

class SpentWatch {
public:
    Spent spent() const { return {wall_.seconds(), processorNow() - start_}; }

private:
    static double processorNow() {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }
    Stopwatch wall_;
    double start_ = processorNow();
};

}  // namespace sgm::viewer
