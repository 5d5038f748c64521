// Time, by the wall or of the processor.
// On a machine that is busy with other work a long run loses a larger part of the wall clock than a short one: there
// only the processor's time compares.
#pragma once

#include <ctime>

namespace sgm::bench {

enum class Clock { Wall, Processor };

/// How things are run, and measured.
struct Running {
    int threads = 2;  ///< at least 1
    Clock clock = Clock::Wall;
};

/// Seconds since construction.
class Stopwatch {
public:
    Stopwatch() = default;
    /// Of the wall; or processor time of the whole program, shared by its threads.
    explicit Stopwatch(Running r)
        : id_(r.clock == Clock::Wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID),
          share_(r.clock == Clock::Wall ? 1.0 : 1.0 / r.threads) {}
    /// Of the wall; or processor time of this thread.
    explicit Stopwatch(Clock clock) : id_(clock == Clock::Wall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID) {}

    double seconds() const { return (now(id_) - start_) * share_; }

private:
    static double now(clockid_t id) {
        timespec t{};
        clock_gettime(id, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }

    clockid_t id_ = CLOCK_MONOTONIC;
    double share_ = 1;
    double start_ = now(id_);
};

}  // namespace sgm::bench
