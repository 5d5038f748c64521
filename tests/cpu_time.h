// Time in tests: that of the processor, for other work on the machine doesn't count. Slow builds have ten times as
// long.
#pragma once

#include <pthread.h>
#include <time.h>

#include <algorithm>

namespace sgm {

/// Whether this build is instrumented: slower, and its programs map far more memory than they use.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool isSanitized = true;
#else
inline constexpr bool isSanitized = false;
#endif

/// Whether this build checks what a release doesn't, and takes several times as long.
#ifdef NDEBUG
inline constexpr bool isSlow = isSanitized;
#else
inline constexpr bool isSlow = true;
#endif

/// A test's bound in seconds, as it holds for a release.
constexpr double boundSeconds(double bound) { return isSlow ? 10 * bound : bound; }

/// CPU seconds that a clock has counted: of the process (CLOCK_PROCESS_CPUTIME_ID) or of one thread.
inline double secondsOf(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The CPU clock of the calling thread, which other threads may read.
inline clockid_t threadClock() {
    clockid_t clock{};
    pthread_getcpuclockid(pthread_self(), &clock);
    return clock;
}

/// The least seconds that `measure` returns in up to five calls, which end once it is no more than `most_s`: other work
/// on the machine may lengthen a measurement.
template <class Measure>
double leastOfFive(double most_s, Measure&& measure) {
    double least_s = measure();
    for (int call = 1; call < 5 && least_s > most_s; ++call) least_s = std::min(least_s, measure());
    return least_s;
}

/// CPU seconds of the calling thread that `work` takes, as leastOfFive.
template <class Work>
double leastSeconds(double most_s, Work&& work) {
    return leastOfFive(most_s, [&] {
        const double begin_s = secondsOf(threadClock());
        work();
        return secondsOf(threadClock()) - begin_s;
    });
}

}  // namespace sgm
