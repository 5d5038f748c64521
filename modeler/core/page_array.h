// A growing array of plain things that isn't copied to grow and leaves no memory unused.
// Enters: elements at its end. Leaves: one piece of memory; from 1 MiB on in huge pages, which the kernel moves to
// another address by their tables. Assumes trivially copyable elements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace sgm {

namespace detail {
/// Memory of another size that begins with what `memory` holds, as much as fits; null for no memory. What is new holds
/// anything. Both sizes in bytes as they were asked for. Throws std::bad_alloc.
void* resizePiece(void* memory, size_t bytes, size_t newBytes);
/// How many bytes are worth asking for when `bytes` are needed: half as many again in small pieces, a quarter in large
/// ones, to whole pages.
size_t roomFor(size_t bytes);
}  // namespace detail

/// A growing array in one piece of memory. Growing doesn't copy large arrays; pointers to elements don't survive it.
template <class T>
class PageArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(sizeof(T) <= 4096 && alignof(T) <= alignof(std::max_align_t));

public:
    using value_type = T;

    PageArray() = default;
    PageArray(const PageArray& other) { append(other); }
    PageArray(PageArray&& other) noexcept { swap(other); }
    PageArray& operator=(PageArray other) noexcept {
        swap(other);
        return *this;
    }
    ~PageArray() { room(0); }

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// How many elements have room; as many as there are after `shrink`.
    size_t capacity() const { return capacity_; }
    T& operator[](size_t i) { return data_[i]; }
    const T& operator[](size_t i) const { return data_[i]; }
    T& back() { return data_[size_ - 1]; }
    const T& back() const { return data_[size_ - 1]; }
    T* begin() { return data_; }
    T* end() { return data_ + size_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }

    /// O(1), a growth apart; throws std::bad_alloc.
    void push_back(const T& value) {
        const T copy = value;  // it may lie in the array itself
        if (size_ == capacity_) room(detail::roomFor((size_ + 1) * sizeof(T)) / sizeof(T));
        data_[size_++] = copy;
    }
    /// Drops what is beyond `size`, which is at most the size so far.
    void truncate(size_t size) { size_ = std::min(size, size_); }
    /// Gives back what isn't used.
    void shrink() { room(size_); }

private:
    void append(const PageArray& other) {
        if (other.empty()) return;
        room(other.size_);
        std::memcpy(static_cast<void*>(data_), other.data_, other.size_ * sizeof(T));
        size_ = other.size_;
    }
    void room(size_t capacity) {
        if (capacity == capacity_) return;
        data_ = static_cast<T*>(detail::resizePiece(data_, capacity_ * sizeof(T), capacity * sizeof(T)));
        capacity_ = capacity;
    }
    void swap(PageArray& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    T* data_ = nullptr;
    size_t size_ = 0, capacity_ = 0;
};

}  // namespace sgm
