// Anonymous memory in huge pages.
// Enters: sizes. Leaves: mappings, which `munmap` gives back. Assumes a system with mmap.
#pragma once

#include <cstddef>

namespace sgm::detail {

inline constexpr size_t hugePage = size_t{2} << 20;  ///< bytes

/// Maps `bytes`, a multiple of 4 KiB, at a multiple of `alignment` (a power of two of at least 4 KiB), and asks for
/// huge pages. The memory is zero. Throws std::bad_alloc.
void* mapPages(size_t bytes, size_t alignment);

}  // namespace sgm::detail
