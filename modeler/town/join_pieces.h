// Polygons that lie side by side, made one.
// Enters: simple polygons without courts that share edges and no area, as cuts leave them. Leaves: their union, exact
// to .1 mm. Assumes at most some hundred: O(n²) in their points.
#pragma once

#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::town {

/// The connected parts of the pieces' union; tags are those of the first piece, which all share. Booleans of a lattice
/// would leave slits between pieces whose common edge has other points on either side.
std::vector<plan::Footprint> joinedPieces(std::vector<plan::Footprint> pieces);

}  // namespace sgm::town
