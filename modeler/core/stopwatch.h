// Wall-clock time.
// Enters: nothing. Leaves: seconds, or sums of them. Assumes nothing.
#pragma once

#include <chrono>
#include <cstdint>

namespace sgm {

/// Seconds since construction.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Time in pieces so short that reading the clock counts.
struct SumOfTimes {
    double seconds = 0;
    uint64_t pieces = 0;
    SumOfTimes& operator+=(const SumOfTimes& o) {
        seconds += o.seconds, pieces += o.pieces;
        return *this;
    }
};

/// Adds the time of its life to a sum; reads no clock where there is none.
class AddTime {
public:
    explicit AddTime(SumOfTimes* sum) : sum_(sum) {
        if (sum_) start_ = std::chrono::steady_clock::now();
    }
    AddTime(const AddTime&) = delete;
    AddTime& operator=(const AddTime&) = delete;
    ~AddTime() {
        if (sum_) *sum_ += {std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), 1};
    }

private:
    SumOfTimes* const sum_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace sgm
