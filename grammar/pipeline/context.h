// What every stage of a pipeline takes beside its input: threads and progress go in, times come out.
// Assumes one caller at a time; Progress alone may be read and cancelled from another thread.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/stopwatch.h"

namespace sgm::pipeline {

/// Seconds by stage, in order of their running.
using Stages = std::vector<std::pair<std::string, double>>;

/// How a run of the stages works and what it measured.
struct Context {
    Progress* progress = nullptr;  ///< reports and cancels; null where nobody asks
    int threads = 0;               ///< 0: all that the machine has
    Stages stages = {};            ///< what ran so far, wall time

    /// Runs `work` and appends its seconds to `stages` under `name`.
    template <class Work>
    auto timed(const char* name, Work&& work) {
        const Stopwatch watch;
        auto result = work();
        stages.emplace_back(name, watch.seconds());
        return result;
    }
};

}  // namespace sgm::pipeline
