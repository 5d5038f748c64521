// How much memory a stretch of work takes at most, as Linux counts resident pages.
#pragma once

#include <cstdint>

namespace sgm::bench {

/// Watches the process from construction on; only one at a time makes sense. Where /proc isn't Linux's, it says 0.
class PeakMemory {
public:
    PeakMemory();
    /// Bytes above what was resident at construction.
    uint64_t bytes() const;

private:
    uint64_t start_bytes_ = 0;
};

}  // namespace sgm::bench
