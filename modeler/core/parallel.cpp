#include "modeler/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace sgm {

int threadCount(int wanted) {
    if (wanted > 0) return wanted;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace detail {

void parallelFor(size_t count, int threads, const Progress* progress, void* context, void (*body)(void*, size_t, int)) {
    if (threads == 1 || count <= 1) {
        for (size_t i = 0; i < count && !cancelled(progress); ++i) body(context, i, 0);
        return;
    }
    // Lets more threads run than the machine has cores: tests of determinism ask for that.
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, count, 1),
            [&](const tbb::blocked_range<size_t>& range) {
                for (size_t i = range.begin(); i != range.end() && !cancelled(progress); ++i)
                    body(context, i, tbb::this_task_arena::current_thread_index());
            },
            tbb::simple_partitioner());
    });
}

}  // namespace detail
}  // namespace sgm
