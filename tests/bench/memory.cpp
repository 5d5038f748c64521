#include "tests/bench/memory.h"

#include <fstream>
#include <string>

#include "modeler/core/pages.h"

namespace sgm::bench {
namespace {

/// A line such as "VmHWM:   1234 kB" of proc(5)'s status, in bytes; 0 where there is none.
uint64_t statusBytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == key + ":") {
            uint64_t kilobytes = 0;
            status >> kilobytes;
            return kilobytes << 10;
        }
    return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
    releasePages(), releaseHeap();                // what earlier work left unused
    std::ofstream("/proc/self/clear_refs") << 5;  // proc(5): resets the peak to what is resident now
    start_bytes_ = statusBytes("VmRSS");
}

uint64_t PeakMemory::bytes() const {
    const uint64_t peak = statusBytes("VmHWM");
    return peak > start_bytes_ ? peak - start_bytes_ : 0;
}

}  // namespace sgm::bench
