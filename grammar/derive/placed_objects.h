// The objects of their own that `place` puts, by what decides them.
// Enters: inputs, as rules evaluate them. Leaves: each distinct object once, and where it is placed. Assumes that
// nothing but its inputs decides an object, so that it can be derived alone and anywhere.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "grammar/rules/value.h"
#include "modeler/core/vec.h"
#include "modeler/plan/polygon.h"

namespace sgm::derive {

/// The scope that an object placed `on lot` grows in: a box about its origin, and its plan.
struct Lot {
    Vec3d size_m{1, 1, 1};
    plan::Footprint footprint;  ///< metres about the centre; empty: the whole rectangle
    friend bool operator==(const Lot&, const Lot&) = default;
};

/// What decides an object: two with equal inputs are the same to the last byte.
struct PlacedObject {
    uint32_t start = 0;                ///< index into Grammar::starts
    std::vector<rules::Value> params;  ///< of the whole grammar, by index
    uint64_t seed = 1;
    std::optional<Lot> lot;  ///< none: it grows in the start's own scope
    friend bool operator==(const PlacedObject&, const PlacedObject&) = default;

    /// A hash of everything; without the seed it tells objects that chance alone may tell apart.
    uint64_t hash(bool withSeed = true) const;
};

/// Distinct objects, numbered in the order in which they were first put.
class PlacedObjects {
public:
    /// The index of the object: an old one where its inputs are known.
    uint32_t put(PlacedObject object);
    const PlacedObject& operator[](size_t index) const { return all_[index]; }
    size_t size() const { return all_.size(); }
    bool empty() const { return all_.empty(); }

private:
    std::vector<PlacedObject> all_;
    std::unordered_multimap<uint64_t, uint32_t> byHash_;
};

}  // namespace sgm::derive
