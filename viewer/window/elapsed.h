// Time on two clocks: the wall's, and the processor's for this thread alone, which other programs don't disturb; and
// where a turn of the window's loop spends it.
#pragma once

#include <ctime>
#include <vector>

#include "modeler/core/stopwatch.h"

namespace sgm::window {

/// Seconds on both clocks.
struct ElapsedTimes {
    double wall = 0, processor = 0;
    ElapsedTimes& operator+=(const ElapsedTimes& o) {
        wall += o.wall;
        processor += o.processor;
        return *this;
    }
    friend ElapsedTimes operator-(const ElapsedTimes& a, const ElapsedTimes& b) {
        return {a.wall - b.wall, a.processor - b.processor};
    }
};

class ElapsedWatch {
public:
    ElapsedTimes spent() const { return {wall_.seconds(), processorNow() - start_}; }

private:
    static double processorNow() {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }
    Stopwatch wall_;
    double start_ = processorNow();
};

/// Between two polls of the user's input, part after part; without drawing.
class FrameTimeline {
public:
    struct Part {
        const char* name;
        ElapsedTimes spent;
    };
    /// What ran since the last call is called so; `drawn` of it was drawing.
    void was(const char* name, const ElapsedTimes& drawn = {}) {
        parts_.push_back({name, watch_.spent() - drawn});
        drawn_ += drawn;
        watch_ = {};
    }
    /// What ran since the last call was drawing.
    void drew() {
        drawn_ += watch_.spent();
        watch_ = {};
    }
    /// What ran since the last call doesn't count: it is for tests alone.
    void leaveOut() { watch_ = {}; }
    const std::vector<Part>& parts() const { return parts_; }
    const ElapsedTimes& drawn() const { return drawn_; }
    ElapsedTimes spent() const {
        ElapsedTimes all;
        for (const Part& part : parts_) all += part.spent;
        return all;
    }

private:
    std::vector<Part> parts_;
    ElapsedTimes drawn_;
    ElapsedWatch watch_;
};

}  // namespace sgm::window
