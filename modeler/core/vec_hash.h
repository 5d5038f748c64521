// Vectors as keys of hash tables.
#pragma once

#include <bit>
#include <cstdint>

#include "modeler/core/random.h"
#include "modeler/core/vec.h"

namespace sgm {

/// Hashes a vector by its bits; −0 and 0, which are equal, are the same.
struct Vec3fHash {
    size_t operator()(const Vec3f& v) const {
        uint64_t h = std::bit_cast<uint32_t>(v.x + 0.0f);
        h = combine(h, std::bit_cast<uint32_t>(v.y + 0.0f));
        return combine(h, std::bit_cast<uint32_t>(v.z + 0.0f));
    }
};

}  // namespace sgm
