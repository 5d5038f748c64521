#include "cli/watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "cli/messages.h"

namespace sgm::cli {
namespace {

// A signal handler can reach nothing but globals; only Watch and EndsAtOnce write them.
std::atomic<Progress*> interrupted{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free);

std::atomic<bool> endsAtOnce{false};

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};

void onInterrupt(int) {
    if (endsAtOnce) _exit(130);
    if (Progress* p = interrupted.load()) p->cancel();
}

void show(const Progress& progress, const std::atomic<bool>& stop) {
    using namespace std::chrono_literals;
    const auto start = std::chrono::steady_clock::now();
    bool shown = false;
    while (!stop) {
        std::this_thread::sleep_for(50ms);
        if (std::chrono::steady_clock::now() - start < 1s) continue;
        printMessage("\r\033[K{} {:3.0f} %", progress.stage(), 100 * progress.fraction());
        std::fflush(stderr);
        shown = true;
    }
    if (shown) printMessage("\r\033[K");
}

void showLines(const Progress& progress, const std::atomic<bool>& stop) {
    using namespace std::chrono_literals;
    for (std::string before; !stop; std::this_thread::sleep_for(50ms)) {
        const std::string stage = progress.stage();
        std::string line = stage.empty() ? "" : fmt::format("progress: {} {:.0f}\n", stage, 100 * progress.fraction());
        if (line != before) writeMessage(line);
        before = std::move(line);
    }
}

}  // namespace

Watch::Watch(ProgressDisplay display) {
    interrupted = &progress_;
    for (size_t i = 0; i < std::size(signals); ++i) {
        before_[i] = std::signal(signals[i], onInterrupt);
        if (signals[i] == SIGHUP && before_[i] == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
    }
    const bool lines = display == ProgressDisplay::Lines;
    if (!lines && (display == ProgressDisplay::None || !isatty(STDERR_FILENO))) return;
    try {
        line_ = std::thread([this, lines] { (lines ? showLines : show)(progress_, stop_); });
    } catch (const std::exception&) {  // the system gives no more threads: there is no line then
    }
}

Watch::~Watch() {
    interrupted = nullptr;
    for (size_t i = 0; i < std::size(signals); ++i)
        std::signal(signals[i], before_[i] == SIG_ERR ? SIG_DFL : before_[i]);
    stop_ = true;
    if (line_.joinable()) line_.join();
}

EndsAtOnce::EndsAtOnce() { endsAtOnce = true; }
EndsAtOnce::~EndsAtOnce() { endsAtOnce = false; }

}  // namespace sgm::cli
