// Boxes that stand side by side as larger ones: most walls of a facade are the pieces between its windows.
// Enters: boxes of one rotation, and what each looks like. Leaves: fewer boxes that fill the same space.
#pragma once

#include <span>
#include <vector>

#include "grammar/derive/shapes.h"

namespace sgm::lower {

/// A box in place of one or several.
struct JoinedBox {
    size_t first;         ///< the first of those
    derive::Scope scope;  ///< its own
};

/// Joins boxes of one look that have a whole face in common, row by row along each axis in turn, until none is left.
/// `scopes` have the same axes; two numbers are one within a micrometre. In the order of `first`, each box that joins
/// none as it was. O(n log n) a round, of which there are three where walls are grids.
std::vector<JoinedBox> joinBoxes(std::span<const derive::Scope> scopes, std::span<const uint32_t> looks);

}  // namespace sgm::lower
