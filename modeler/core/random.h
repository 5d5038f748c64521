// Counter-based random numbers: a draw is a pure function of a 64-bit key, so streams need no state and no order.
// Enters: keys. Leaves: hashes and uniform numbers, the same on every machine. Assumes only 64-bit integer arithmetic.
// Mixing: the finaliser of splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
#pragma once

#include <cstdint>
#include <string_view>

namespace sgm {

/// A bijective mix of all 64 bits.
constexpr uint64_t mix(uint64_t v) {
    v += 0x9e3779b97f4a7c15ull;
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
    return v ^ (v >> 31);
}

/// The key of `child` under `parent`; order matters.
constexpr uint64_t combine(uint64_t parent, uint64_t child) { return mix(parent ^ mix(child)); }

/// The key of a text (FNV-1a, then mixed).
constexpr uint64_t hashText(std::string_view text) {
    uint64_t h = 0xcbf29ce484222325ull;
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return mix(h);
}

/// A number in [0, 1), 53 bits, decided by `key` alone.
constexpr double uniform(uint64_t key) { return static_cast<double>(mix(key) >> 11) * 0x1.0p-53; }

/// A number from lo to hi (which only rounding reaches), decided by `key` alone.
constexpr double uniform(uint64_t key, double lo, double hi) { return lo + (hi - lo) * uniform(key); }

/// An integer in [0, count), decided by `key` alone. `count` must be positive.
constexpr uint64_t pick(uint64_t key, uint64_t count) {
    return static_cast<uint64_t>(uniform(key) * static_cast<double>(count));
}

}  // namespace sgm
