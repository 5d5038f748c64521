#include "cli/watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

namespace sgm::cli {
namespace {

// A signal handler can reach nothing but a global; only Watch writes it.
std::atomic<Progress*> interrupted{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free);

void onInterrupt(int) {
    if (Progress* p = interrupted.load()) p->cancel();
}

void show(const Progress& progress, const std::atomic<bool>& stop) {
    using namespace std::chrono_literals;
    const auto start = std::chrono::steady_clock::now();
    bool shown = false;
    while (!stop) {
        std::this_thread::sleep_for(50ms);
        if (std::chrono::steady_clock::now() - start < 1s) continue;
        fmt::print(stderr, "\r\033[K{} {:3.0f} %", progress.stage(), 100 * progress.fraction());
        std::fflush(stderr);
        shown = true;
    }
    if (shown) fmt::print(stderr, "\r\033[K");
}

}  // namespace

Watch::Watch(bool quiet) {
    interrupted = &progress_;
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    if (!quiet && isatty(STDERR_FILENO)) line_ = std::thread([this] { show(progress_, stop_); });
}

Watch::~Watch() {
    interrupted = nullptr;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    stop_ = true;
    if (line_.joinable()) line_.join();
}

}  // namespace sgm::cli
