// Parallel loops on a chosen number of threads.
// Enters: a count and a body. Leaves: nothing; the body writes only to its own index's slot, so that order can't show.
// Assumes the body takes long enough to be worth a step of an atomic counter. Threads stay for the loops to come; a
// loop never waits for one that is slow to come, and does without where there is none.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

#include "modeler/core/progress.h"

namespace sgm {

/// Threads to use for `wanted` (0 = all the machine has).
int threadCount(int wanted);

namespace detail {
void parallelFor(size_t count, int threads, const Progress* progress, void* context,
                 void (*body)(void*, size_t index, int worker));
}

/// Calls body(index, worker) once for every index in [0, count), on `threads` threads; `worker` in [0, threads) tells
/// which scratch to use. Stops handing out indices once `progress` is cancelled or a body throws; the caller throws it
/// then.
template <class Body>
void parallelFor(size_t count, int threads, const Progress* progress, Body&& body) {
    using B = std::remove_reference_t<Body>;
    detail::parallelFor(count, threadCount(threads), progress,
                        const_cast<void*>(static_cast<const void*>(std::addressof(body))),
                        [](void* context, size_t index, int worker) { (*static_cast<B*>(context))(index, worker); });
}

}  // namespace sgm
