// Curves in place of the bends of roads (paper A, 6, wishes them).
// Enters: a planar graph. Leaves: one whose bends, where two pieces of one class meet, are circular arcs of no less
// than the class's least radius, as chords that lie within 20 cm of them. Assumes a finished net: crossings stay.
#pragma once

#include "modeler/town/grow.h"

namespace sgm::town {

/// Rounds every bend that has room: the widest arc that leaves half of both pieces. One that would be tighter than the
/// least radius, would run over water, through a park, out of the area, or touch another road stays a corner; the
/// lattice's exact test decides. Pieces of one curve carry its number.
void curveBends(RoadGraph& graph, const RoadParameters& parameters, const Land& land);

}  // namespace sgm::town
