// Memory for large results: cut from regions of huge pages, kept for the next result when it is freed.
// Enters: sizes. Leaves: 64-byte aligned memory that nobody has cleared. Assumes arrays of plain numbers: a fresh page
// of 4 KiB costs seven times as long as its share of a huge one (the kernel maps and clears it), and more than
// computing what goes into it.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

namespace sgm {

namespace detail {
/// Any thread may free what another has allocated. Throws std::bad_alloc.
void* allocatePages(size_t bytes);
/// `bytes` as they were asked for.
void freePages(void* memory, size_t bytes) noexcept;
}  // namespace detail

/// Gives regions that nothing lies in back to the system. Otherwise up to 4 GiB stay, all but 256 MiB its to reclaim.
void releasePages() noexcept;

/// Gives what the heap holds unused back to the system, down to single pages. The C library keeps what lies between
/// pieces in use, which is hundreds of MiB after some models. Takes milliseconds, by how many pieces there are.
void releaseHeap() noexcept;

/// Memory that has been allocated and not written yet.
struct UnusedMemory {
    const void* begin = nullptr;
    size_t bytes = 0;
};

/// Has the system clear these, all of them side by side from their beginnings, or until `isEnough`: what is written to
/// pages that are cleared already doesn't wait for it, so it is worth a thread beside the one that writes. Does nothing
/// with what is smaller than a huge page, and nothing where the system can't.
void clearAhead(std::span<const UnusedMemory> memory, const std::atomic<bool>* isEnough = nullptr) noexcept;

/// For std::vector: a `resize` leaves new elements as the memory was, to be written once.
template <class T>
struct PageAllocator {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    using value_type = T;
    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>&) {}
    T* allocate(size_t n) { return static_cast<T*>(detail::allocatePages(n * sizeof(T))); }
    void deallocate(T* p, size_t n) noexcept { detail::freePages(p, n * sizeof(T)); }
    void construct(T*) noexcept {}
    template <class... Args>
    void construct(T* p, Args&&... args) {
        ::new (static_cast<void*>(p)) T{std::forward<Args>(args)...};
    }
    friend bool operator==(PageAllocator, PageAllocator) { return true; }
};

/// The same for vectors of which most are small and some are large: only these lie in huge pages.
template <class T>
struct LargePageAllocator : PageAllocator<T> {
    using value_type = T;
    LargePageAllocator() = default;
    template <class U>
    LargePageAllocator(const LargePageAllocator<U>&) {}
    T* allocate(size_t n) {
        return isLarge(n) ? PageAllocator<T>::allocate(n) : static_cast<T*>(::operator new(n * sizeof(T)));
    }
    void deallocate(T* p, size_t n) noexcept {
        if (isLarge(n))
            PageAllocator<T>::deallocate(p, n);
        else
            ::operator delete(p, n * sizeof(T));
    }

private:
    static constexpr size_t leastBytes = 1 << 20;
    static bool isLarge(size_t n) { return n * sizeof(T) >= leastBytes; }
};

/// For std::vector of many elements that aren't plain: they are made and ended as in any vector.
template <class T>
struct ObjectPageAllocator {
    using value_type = T;
    ObjectPageAllocator() = default;
    template <class U>
    ObjectPageAllocator(const ObjectPageAllocator<U>&) {}
    T* allocate(size_t n) { return static_cast<T*>(detail::allocatePages(n * sizeof(T))); }
    void deallocate(T* p, size_t n) noexcept { detail::freePages(p, n * sizeof(T)); }
    friend bool operator==(ObjectPageAllocator, ObjectPageAllocator) { return true; }
};

/// A vector for what is large and plain; elements added by `resize(n)` hold anything until they are written.
template <class T>
using PageVector = std::vector<T, PageAllocator<T>>;

/// The same where only large ones are worth pages of their own.
template <class T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

/// What a vector has room for beyond its elements.
template <class Vector>
UnusedMemory unusedOf(const Vector& vector) {
    return {vector.data() + vector.size(), (vector.capacity() - vector.size()) * sizeof(typename Vector::value_type)};
}

}  // namespace sgm
