// Footprints cut into parts.
// Enters: sound footprints (validate.h). Leaves: parts whose areas sum to the whole. Assumes coordinates within 10⁵ m.
// New edges are EdgeSource::Cut without a tag; the others keep theirs.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// A cut through the plan: the points with dot(normal, p) ≤ offset are kept. `normal` need not have length 1.
struct HalfPlane {
    Vec2 normal{1, 0};
    double offset = 0;
};
/// The part in the half-plane; empty where there is none. O(n log n).
Footprint clipped(const Footprint& footprint, const HalfPlane& keep);
/// The part between two coordinates along x (axis 0) or z (axis 1).
Footprint between(const Footprint& footprint, int axis, double from_m, double to_m);

/// A run of consecutive edges of one ring.
struct Chain {
    uint32_t polygon = 0, ring = 0;
    uint32_t first = 0, count = 0;  ///< edges first, first + 1, … of the ring, modulo its size
};
/// The longest run of edges for which `belongs` holds (by number as in edgesOf()); count 0 where there is none.
Chain longestChain(const Footprint& footprint, const std::vector<bool>& belongs);
/// Metres along a chain.
double length(const Footprint& footprint, const Chain& chain);

/// A part of a split along a chain.
struct AlongPart {
    Footprint footprint;
    Vec2 from, to;  ///< its chord: the ends of its piece of the chain
};
/// The chain's polygon cut across at the lengths `at_m` along the chain (ascending, inside (0, length)), square to the
/// chain (at its corners along the bisector; where it bends by less than 30° the direction turns from corner to
/// corner), each cut up to the nearest other edge or earlier cut. n + 1 parts for n cuts, in the chain's order; a
/// polygon with courts, and one whose whole outline is the chain, is also cut where the chain begins. Other polygons of
/// the footprint belong to no part. Error::Input where a length isn't inside the chain or is less than a millimetre
/// behind the one before.
Result<std::vector<AlongPart>> splitAlong(const Footprint& footprint, const Chain& chain, std::span<const double> at_m);

/// Parts of the given areas, cut off one after the other along x (axis 0) or z (axis 1); the last part is what is left.
/// Areas beyond what is left are cut off; parts may be empty then. Each area is met within 10⁻⁴ m².
std::vector<Footprint> splitByArea(const Footprint& footprint, int axis, std::span<const double> areas_m2);

}  // namespace sgm::plan
