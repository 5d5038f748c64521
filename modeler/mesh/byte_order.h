// Numbers of binary files.
// Enters: bytes in a known order. Leaves: numbers. Assumes that the machine's own order is little-endian.
#pragma once

#include <bit>
#include <cstring>

namespace sgm::mesh {

static_assert(std::endian::native == std::endian::little);

/// The number whose bytes begin at `bytes`.
template <class T>
T numberAt(const char* bytes, bool bigEndian = false) {
    char ordered[sizeof(T)];
    for (size_t i = 0; i < sizeof(T); ++i) ordered[i] = bytes[bigEndian ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, ordered, sizeof value);
    return value;
}

}  // namespace sgm::mesh
