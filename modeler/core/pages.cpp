#include "modeler/core/pages.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <new>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "modeler/core/map_pages.h"

namespace sgm {
namespace {

using detail::hugePage;
constexpr size_t regionBytes = 4 * hugePage;
constexpr size_t mostFreeRegions = 512;
/// Free regions beyond these are the system's to take back, should it need memory.
constexpr size_t mostHeldRegions = 32;
constexpr size_t lineBytes = 64;
/// Larger pieces get a mapping of their own.
constexpr size_t largest = regionBytes / 4;

/// The start of a region: pieces are cut one after the other and never reused before all of them are free.
struct alignas(lineBytes) Region {
    std::atomic<size_t> pieces{1};  ///< not yet freed; the thread that cuts from it counts as one
    size_t used = sizeof(Region);
    Region* next = nullptr;  ///< in the list of free ones
};

/// Regions that nothing lies in.
class FreeRegions {
public:
    Region* take() {
        {
            const std::lock_guard lock(mutex_);
            if (Region* const region = first_) {
                first_ = region->next;
                --count_;
                return new (region) Region;
            }
        }
        return new (detail::mapPages(regionBytes, regionBytes)) Region;
    }
    void put(Region* region) {
        const std::lock_guard lock(mutex_);
        if (count_ == mostFreeRegions || (count_ >= mostHeldRegions && !offer(region))) {
            munmap(region, regionBytes);
            return;
        }
        region->next = first_;
        first_ = region;
        ++count_;
    }
    void release() {
        const std::lock_guard lock(mutex_);
        for (; first_; --count_) {
            Region* const next = first_->next;
            munmap(first_, regionBytes);
            first_ = next;
        }
    }

private:
    /// Leaves a region's pages to the system until they are written again; false where it knows no such thing.
    static bool offer(Region* region) {
#if defined(MADV_FREE)
        return madvise(region, regionBytes, MADV_FREE) == 0;
#else
        static_cast<void>(region);
        return false;
#endif
    }

    std::mutex mutex_;
    Region* first_ = nullptr;
    size_t count_ = 0;
};

/// Never destroyed: threads give regions back until the very end.
FreeRegions& freeRegions() {
    static FreeRegions& regions = *new FreeRegions;
    return regions;
}

void drop(Region* region) {
    if (region->pieces.fetch_sub(1, std::memory_order_acq_rel) == 1) freeRegions().put(region);
}

/// The region a thread cuts from.
struct Current {
    Region* region = nullptr;
    ~Current() {
        if (region) drop(region);
    }
};

}  // namespace

namespace detail {

void* allocatePages(size_t bytes) {
    if (bytes > largest) return mapPages((bytes + hugePage - 1) / hugePage * hugePage, hugePage);
    static thread_local Current current;
    const size_t rounded = (bytes + lineBytes - 1) / lineBytes * lineBytes;
    Region*& region = current.region;
    if (region && region->pieces.load(std::memory_order_acquire) == 1) region->used = sizeof(Region);
    if (!region || region->used + rounded > regionBytes) {
        if (region) drop(region);
        region = nullptr;
        region = freeRegions().take();
    }
    char* const piece = reinterpret_cast<char*>(region) + region->used;
    region->used += rounded;
    region->pieces.fetch_add(1, std::memory_order_relaxed);
    return piece;
}

void freePages(void* memory, size_t bytes) noexcept {
    if (bytes > largest) {
        munmap(memory, (bytes + hugePage - 1) / hugePage * hugePage);
        return;
    }
    const uintptr_t at = reinterpret_cast<uintptr_t>(memory);
    drop(reinterpret_cast<Region*>(at - at % regionBytes));
}

}  // namespace detail

void releasePages() noexcept { freeRegions().release(); }

void releaseHeap() noexcept {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void clearAhead(std::span<const UnusedMemory> memory, const std::atomic<bool>* isEnough) noexcept {
#if defined(MADV_POPULATE_WRITE)
    constexpr size_t mostSteps = 64;  // of each
    for (size_t step = 0; step < mostSteps; ++step)
        for (const UnusedMemory& m : memory) {
            // Whole pages alone: others hold something else.
            const size_t from = reinterpret_cast<uintptr_t>(m.begin), begin = (from + hugePage - 1) / hugePage,
                         end = std::max((from + m.bytes) / hugePage, begin),
                         first = begin + (end - begin) * step / mostSteps,
                         last = begin + (end - begin) * (step + 1) / mostSteps;
            if (first == last) continue;
            if (isEnough && isEnough->load(std::memory_order_relaxed)) return;
            if (madvise(reinterpret_cast<void*>(first * hugePage), (last - first) * hugePage, MADV_POPULATE_WRITE) != 0)
                return;
        }
#else
    static_cast<void>(memory), static_cast<void>(isEnough);
#endif
}

}  // namespace sgm
