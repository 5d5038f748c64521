#include "modeler/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace sgm {

int threadCount(int wanted) {
    if (wanted > 0) return wanted;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace detail {

void parallelFor(size_t count, int threads, const Progress* progress, void* context, void (*body)(void*, size_t, int)) {
    std::atomic<size_t> next{0};
    const auto work = [&](int worker) {
        while (!cancelled(progress)) {
            const size_t i = next.fetch_add(1, std::memory_order_relaxed);
            if (i >= count) break;
            body(context, i, worker);
        }
    };
    std::vector<std::jthread> others;  // joined at the end
    try {
        for (int worker = 1; worker < threads && static_cast<size_t>(worker) < count; ++worker)
            others.emplace_back(work, worker);
    } catch (const std::system_error&) {
        // The system gives no more threads: those there are do the work.
    }
    work(0);
}

}  // namespace detail
}  // namespace sgm
