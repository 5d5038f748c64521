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

/// CPU seconds of the calling thread that `work` takes: the least of up to five runs, which go on while they take
/// longer than `most_s`, for other work on the machine may lengthen one.
template <class Work>
double leastSeconds(double most_s, Work&& work) {
    double least_s = 0;
    for (int run = 0; run < 5 && (run == 0 || least_s > most_s); ++run) {
        const double begin_s = secondsOf(threadClock());
        work();
        const double taken_s = secondsOf(threadClock()) - begin_s;
        least_s = run == 0 ? taken_s : std::min(least_s, taken_s);
    }
    return least_s;
}

}  // namespace sgm
