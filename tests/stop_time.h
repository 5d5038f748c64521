// How soon work stops after a cancel, in CPU time.
// Enters: the work, and when to cancel it. Leaves: seconds. Assumes that the work looks at its progress.
#pragma once

#include <chrono>
#include <thread>

#include "modeler/core/progress.h"
#include "tests/cpu_time.h"

namespace sgm {

/// CPU seconds that `work(progress)` takes from its cancel to its end, on the clock of the process or of the calling
/// thread, as leastOfFive. A second thread cancels it as soon as `isReady(progress)` is true.
template <class IsReady, class Work>
double leastSecondsToStop(double most_s, clockid_t clock, IsReady&& isReady, Work&& work) {
    return leastOfFive(most_s, [&] {
        Progress progress;
        double cancelled_s = 0;
        std::thread watcher([&] {
            while (!isReady(progress)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            cancelled_s = secondsOf(clock);
            progress.cancel();
        });
        work(progress);
        const double ended_s = secondsOf(clock);
        watcher.join();
        return ended_s - cancelled_s;
    });
}

}  // namespace sgm
