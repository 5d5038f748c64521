// Values of which many are equal, each stored once.
// Enters: values. Leaves: an index for each, the same for the same. Assumes that the same values have
// the same hash.
#pragma once

#include <cstdint>
#include <vector>

namespace sgm::derive {

/// Different values and their indices. `Equality` has `hashOf(value)` and `isSame(a, b)`.
template <class T, class Equality>
class ValueTable {
public:
    ValueTable() { put(T{}); }

    /// The index of a value; that of T{} is 0. O(1).
    uint32_t put(const T& value) {
        const uint64_t hash = Equality::hashOf(value);
        size_t i = hash & (slots_.size() - 1);
        for (; slots_[i] != empty; i = (i + 1) & (slots_.size() - 1))
            if (Equality::isSame(values_[slots_[i]], value)) return slots_[i];
        const auto index = static_cast<uint32_t>(values_.size());
        slots_[i] = index;
        values_.push_back(value);
        if (2 * values_.size() > slots_.size()) grow();
        return index;
    }
    /// The same, faster where it is the value at `hint`.
    uint32_t put(const T& value, uint32_t hint) { return Equality::isSame(values_[hint], value) ? hint : put(value); }
    const T& operator[](uint32_t index) const { return values_[index]; }
    size_t size() const { return values_.size(); }
    /// Bytes.
    uint64_t memory() const { return values_.capacity() * sizeof(T) + slots_.capacity() * sizeof(uint32_t); }
    /// Gives back what isn't used.
    void shrink() { values_.shrink_to_fit(); }

private:
    static constexpr uint32_t empty = ~0u;

    void grow() {
        slots_.assign(2 * slots_.size(), empty);
        for (uint32_t index = 0; index < values_.size(); ++index) {
            size_t i = Equality::hashOf(values_[index]) & (slots_.size() - 1);
            while (slots_[i] != empty) i = (i + 1) & (slots_.size() - 1);
            slots_[i] = index;
        }
    }

    std::vector<T> values_;
    std::vector<uint32_t> slots_ = std::vector<uint32_t>(16, empty);  ///< a power of two, at least half of them empty
};

}  // namespace sgm::derive
