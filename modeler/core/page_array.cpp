#include "modeler/core/page_array.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

#include "modeler/core/map_pages.h"

namespace sgm::detail {
namespace {

constexpr size_t page = 4096;
/// Pieces up to here come from the heap; larger ones are mappings of their own.
constexpr size_t largestSmall = hugePage / 2;

size_t roundedUp(size_t bytes, size_t unit) { return (bytes + unit - 1) / unit * unit; }

bool isMapped(size_t bytes) { return bytes > largestSmall; }
size_t mappedBytes(size_t bytes) { return roundedUp(bytes, page); }

void* remapped(void* memory, size_t bytes, size_t newBytes) {
    if (bytes == newBytes) return memory;
    if (newBytes < bytes) {
        munmap(static_cast<char*>(memory) + newBytes, bytes - newBytes);
        return memory;
    }
    void* const target = mapPages(newBytes, hugePage);
#if defined(MREMAP_FIXED)
    // Both begin at a huge page, so whole tables of pages move.
    if (mremap(memory, bytes, newBytes, MREMAP_MAYMOVE | MREMAP_FIXED, target) != target) {
        munmap(target, newBytes);
        throw std::bad_alloc();
    }
#else
    std::memcpy(target, memory, bytes);
    munmap(memory, bytes);
#endif
    return target;
}

void* resizedSmall(void* memory, size_t newBytes) {
    void* const piece = std::realloc(memory, newBytes);
    if (!piece) throw std::bad_alloc();
    return piece;
}

void release(void* memory, size_t bytes) {
    if (isMapped(bytes))
        munmap(memory, mappedBytes(bytes));
    else
        std::free(memory);
}

}  // namespace

void* resizePiece(void* memory, size_t bytes, size_t newBytes) {
    if (newBytes == 0) {
        if (memory) release(memory, bytes);
        return nullptr;
    }
    const bool wasMapped = memory && isMapped(bytes);
    if (wasMapped && isMapped(newBytes)) return remapped(memory, mappedBytes(bytes), mappedBytes(newBytes));
    if (!wasMapped && !isMapped(newBytes)) return resizedSmall(memory, newBytes);
    void* const piece =
        isMapped(newBytes) ? mapPages(mappedBytes(newBytes), hugePage) : resizedSmall(nullptr, newBytes);
    if (!memory) return piece;
    std::memcpy(piece, memory, bytes < newBytes ? bytes : newBytes);
    release(memory, bytes);
    return piece;
}

size_t roomFor(size_t bytes) {
    constexpr size_t least = 64;
    if (!isMapped(bytes + bytes / 2)) return bytes + bytes / 2 + least;
    return roundedUp(bytes + bytes / 4, hugePage);
}

}  // namespace sgm::detail
