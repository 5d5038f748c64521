#include "modeler/core/map_pages.h"

#include <sys/mman.h>

#include <cstdint>
#include <new>

namespace sgm::detail {

void* mapPages(size_t bytes, size_t alignment) {
    void* const mapped =
        mmap(nullptr, bytes + alignment, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    char* const from = static_cast<char*>(mapped);
    const size_t before = (alignment - reinterpret_cast<uintptr_t>(from) % alignment) % alignment;
    if (before > 0) munmap(from, before);
    munmap(from + before + bytes, alignment - before);
#if defined(MADV_HUGEPAGE)
    madvise(from + before, bytes, MADV_HUGEPAGE);
#endif
    return from + before;
}

}  // namespace sgm::detail
