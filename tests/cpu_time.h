// CPU time in tests: other work on the machine doesn't count, instrumented code is given ten times as long.
#pragma once

#include <pthread.h>
#include <time.h>

namespace sgm {

/// A test's bound in CPU seconds, as it holds for a plain build.
constexpr double cpuSeconds(double bound) {
#ifdef __SANITIZE_ADDRESS__
    return 10 * bound;
#else
    return bound;
#endif
}

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

}  // namespace sgm
