// How soon work stops after a cancel, in CPU time.
// Enters: the work, and when to cancel it. Leaves: seconds. Assumes that the work looks at its progress.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

#include "modeler/core/progress.h"
#include "tests/cpu_time.h"

namespace sgm {

/// CPU seconds, on the clock of the process or of the calling thread, that `work(progress)` goes on after the cancel,
/// which another thread asks for once `isReady(progress)` holds: the least of up to five runs, which go on while they
/// take longer than `most_s`, for other work on the machine may lengthen one.
template <class IsReady, class Work>
double leastSecondsToStop(double most_s, clockid_t clock, IsReady&& isReady, Work&& work) {
    double least_s = 0;
    for (int run = 0; run < 5 && (run == 0 || least_s > most_s); ++run) {
        Progress progress;
        double asked_s = 0;
        std::thread watcher([&] {
            while (!isReady(progress)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            asked_s = secondsOf(clock);
            progress.cancel();
        });
        work(progress);
        const double ended_s = secondsOf(clock);
        watcher.join();
        least_s = run == 0 ? ended_s - asked_s : std::min(least_s, ended_s - asked_s);
    }
    return least_s;
}

}  // namespace sgm
