// Which shapes of a tree are alike but for where they stand.
// Enters: a Derivation and its Model. Leaves: a number a shape. Assumes that the model was lowered from that
// derivation.
#pragma once

#include <cstdint>
#include <vector>

#include "grammar/lower/lower.h"

namespace sgm::lower {

/// By shape: a number that two shapes share where moving one puts all of its content onto the other's: equal solids,
/// sizes, orientations, materials and joins, to a micrometre and a millionth. 0 for shapes that are like no other:
/// noise depends on the place, and what blends into its surroundings on these. A hash; O(shapes).
std::vector<uint64_t> likenesses(const derive::Derivation& derivation, const Model& model);

}  // namespace sgm::lower
