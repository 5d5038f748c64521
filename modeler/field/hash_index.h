// Ids by hash: a table of open addresses, for collections that only grow and keep their items elsewhere.
// Enters: 64-bit hashes, of which the low half counts, spread over their range, and ids. Leaves: the id whose item the
// caller recognises. Assumes ids below 2³² − 1. Linear probing, at most half full (Knuth, "The Art of Computer
// Programming" 6.4, algorithm L): no allocation an item.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "modeler/core/pages.h"

namespace sgm::field {

class HashIndex {
public:
    static constexpr uint32_t none = 0xffffffffu;

    /// The id entered under `hash` for which same(id) is true; `none` when there is none.
    template <class Same>
    uint32_t find(uint64_t hash, Same&& same) const {
        if (places_.empty()) return none;
        const auto tag = static_cast<uint32_t>(hash);
        for (size_t at = tag & mask(); places_[at].id != none; at = (at + 1) & mask())
            if (places_[at].tag == tag && same(places_[at].id)) return places_[at].id;
        return none;
    }

    /// Makes room for `count` ids in all.
    void reserve(size_t count) {
        if (2 * count > places_.size()) resize(std::bit_ceil(2 * count));
    }
    /// Enters an id whose item isn't there yet.
    void insert(uint64_t hash, uint32_t id) {
        if (2 * (count_ + 1) > places_.size()) resize(std::max<size_t>(64, 2 * places_.size()));
        put({static_cast<uint32_t>(hash), id});
        ++count_;
    }

private:
    struct Place {
        uint32_t tag = 0;  ///< low half of the hash
        uint32_t id = none;
    };

    size_t mask() const { return places_.size() - 1; }
    void put(Place place) {
        size_t at = place.tag & mask();
        while (places_[at].id != none) at = (at + 1) & mask();
        places_[at] = place;
    }
    void resize(size_t count) {
        const PageVector<Place> old = std::exchange(places_, PageVector<Place>(count, Place{}));
        for (const Place& place : old)
            if (place.id != none) put(place);
    }

    PageVector<Place> places_;  ///< a power of two of them
    size_t count_ = 0;
};

}  // namespace sgm::field
