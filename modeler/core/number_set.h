// A set of numbers.
// Enters: numbers but 0. Leaves: whether one is among them. Assumes numbers whose low bits differ, such as hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgm {

/// Numbers but 0, in a table of a power of two with room for twice as many: they are asked for millions of times.
class NumberSet {
public:
    /// Whether it was not there. Amortised O(1).
    bool insert(uint64_t number);
    bool contains(uint64_t number) const;

private:
    bool place(uint64_t number);
    void grow();

    std::vector<uint64_t> slots_ = std::vector<uint64_t>(1024);
    size_t count_ = 0;
};

}  // namespace sgm
