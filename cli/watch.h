// What the user sees of long work: a progress line, and Ctrl-C.
// Enters: a Progress. Leaves: a line on the terminal. Assumes one Watch at a time.
#pragma once

#include <array>
#include <thread>

#include "modeler/core/progress.h"

namespace sgm::cli {

/// While it lives, Ctrl-C (and SIGTERM, and a terminal that is closed) cancels `progress()`, and a line on stderr shows
/// the stage once a second has passed (on a terminal only, and not when quiet).
class Watch {
public:
    explicit Watch(bool quiet);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    Progress* progress() { return &progress_; }

private:
    Progress progress_;
    std::atomic<bool> stop_{false};
    std::thread line_;
    std::array<void (*)(int), 3> before_{};  ///< what signals did
};

}  // namespace sgm::cli
