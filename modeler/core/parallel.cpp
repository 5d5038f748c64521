#include "modeler/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sgm {
namespace {

/// A loop under way.
struct Loop {
    const size_t count;
    const Progress* const progress;
    void* const context;
    void (*const body)(void*, size_t, int);
    int slots;  ///< for threads that may still join it; guarded, as the next two are, by the pool's mutex
    int joined = 0, busy = 0;
    std::condition_variable left;
    std::atomic<size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;  ///< of the thread that set `failed`

    /// Nothing is thrown here: no thread may leave a loop that others still work on.
    void work(int worker) noexcept {
        try {
            while (!cancelled(progress) && !failed.load(std::memory_order_relaxed)) {
                const size_t i = next.fetch_add(1, std::memory_order_relaxed);
                if (i >= count) break;
                body(context, i, worker);
            }
        } catch (...) {
            if (!failed.exchange(true)) failure = std::current_exception();
        }
    }
    /// For the caller, once all threads have left.
    void rethrow() const {
        if (failure) std::rethrow_exception(failure);
    }
};

/// Threads that wait for loops. A caller never waits for one that hasn't joined: where all are slow to come, it does
/// the work itself.
class ThreadPool {
public:
    /// Runs a loop on the calling thread and on up to loop.slots others.
    void run(Loop& loop) {
        const int others = loop.slots;
        {
            const std::lock_guard lock(mutex_);
            open_.push_back(&loop);  // first, for it may throw
            spawn(others);
            free_ -= others;
        }
        for (int i = 0; i < others; ++i) called_.notify_one();
        loop.work(0);
        std::unique_lock lock(mutex_);
        free_ += loop.slots;
        loop.slots = 0;
        std::erase(open_, &loop);
        loop.left.wait(lock, [&] { return loop.busy == 0; });
    }

private:
    /// Sees to it that so many threads are free, unless the system gives no more: then those there are do the work.
    void spawn(int wanted) {
        try {
            for (; free_ < wanted; ++free_) std::thread([this] { workerMain(); }).detach();
        } catch (const std::exception&) {
        }
    }
    [[noreturn]] void workerMain() {
        std::unique_lock lock(mutex_);
        for (;;) {
            called_.wait(lock, [&] { return !open_.empty(); });
            Loop& loop = *open_.front();
            if (--loop.slots == 0) open_.erase(open_.begin());
            const int worker = ++loop.joined;
            ++loop.busy;
            lock.unlock();
            loop.work(worker);
            lock.lock();
            ++free_;
            if (--loop.busy == 0) loop.left.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable called_;
    std::vector<Loop*> open_;  ///< those with slots
    int free_ = 0;             ///< threads beyond those that the open loops have slots for
};

/// Never destroyed: its threads wait until the very end.
ThreadPool& threadPool() {
    static ThreadPool& pool = *new ThreadPool;
    return pool;
}

}  // namespace

int threadCount(int wanted) {
    if (wanted > 0) return wanted;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace detail {

void parallelFor(size_t count, int threads, const Progress* progress, void* context, void (*body)(void*, size_t, int)) {
    const int others = static_cast<int>(std::min(static_cast<size_t>(threads), std::max<size_t>(count, 1))) - 1;
    Loop loop{count, progress, context, body, others, 0, 0, {}, {}, {}, {}};
    if (others > 0)
        threadPool().run(loop);
    else
        loop.work(0);
    loop.rethrow();
}

}  // namespace detail
}  // namespace sgm
