// What the user sees of long work: a progress line, and Ctrl-C.
// Enters: a Progress. Leaves: a line on the terminal. Assumes one Watch at a time.
#pragma once

#include <array>
#include <thread>

#include "modeler/core/progress.h"

namespace sgm::cli {

/// How a Watch shows progress: as a line on a terminal, kept up to date once a second has passed; as lines on stderr
/// for other programs, `progress: STAGE PERCENT`; or not at all.
enum class ProgressDisplay { Terminal, Lines, None };

/// While it lives, Ctrl-C (and SIGTERM, and a terminal that is closed) cancels `progress()`, and stderr shows how far
/// it is.
class Watch {
public:
    explicit Watch(ProgressDisplay display);
    explicit Watch(bool quiet) : Watch(quiet ? ProgressDisplay::None : ProgressDisplay::Terminal) {}
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

/// While it lives, what ends a Watch ends the program at once with exit code 130: for stages that have written nothing
/// and don't look at a Progress at every step, such as parsing.
class EndsAtOnce {
public:
    EndsAtOnce();
    ~EndsAtOnce();
    EndsAtOnce(const EndsAtOnce&) = delete;
    EndsAtOnce& operator=(const EndsAtOnce&) = delete;
};

}  // namespace sgm::cli
