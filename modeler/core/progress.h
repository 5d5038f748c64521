// Progress and cancel for long work.
// Enters: ticks from any thread. Leaves: a fraction for whoever shows it, and the request to stop. Assumes polls within
// 50 ms.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "modeler/core/result.h"

namespace sgm {

/// Shared between a worker and its watcher; all members may be used from any thread. Functions accept a null
/// `Progress*`: no progress is reported then, and nothing cancels.
class Progress {
public:
    Progress() = default;
    /// Of one part of the work that `above` watches, with stages of its own: cancelled when `above` is, which outlives
    /// it and may be null.
    explicit Progress(const Progress* above) : above_(above) {}

    /// Names the stage (a string literal; it must outlive this object) and says how many ticks it has.
    void begin(const char* stage, uint64_t ticks) {
        stage_ = stage;
        total_ = ticks;
        done_ = 0;
    }
    void tick(uint64_t n = 1) { done_.fetch_add(n, std::memory_order_relaxed); }
    void cancel() { cancelled_ = true; }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed) || (above_ && above_->cancelled()); }
    const char* stage() const { return stage_; }
    /// Share of the present stage that is done, 0 … 1.
    double fraction() const {
        const auto total = total_.load();
        return total ? std::min(1.0, static_cast<double>(done_.load()) / static_cast<double>(total)) : 0.0;
    }

private:
    std::atomic<const char*> stage_{""};
    std::atomic<uint64_t> total_{0}, done_{0};
    std::atomic<bool> cancelled_{false};
    const Progress* above_ = nullptr;
};

inline bool cancelled(const Progress* p) { return p && p->cancelled(); }
inline void tick(Progress* p, uint64_t n = 1) {
    if (p) p->tick(n);
}

/// The error of a function that stopped because it was cancelled.
inline Error cancelledError() { return {Error::Kind::Cancelled, "cancelled"}; }

}  // namespace sgm
