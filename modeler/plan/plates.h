// Walls of a footprint: a plate along every edge, mitred with its neighbours, and the core they enclose; bands along
// lines. Enters: sound footprints and thicknesses in metres. Leaves: sound footprints that don't overlap. Assumes
// coordinates within 10⁵ m.
#pragma once

#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// What stands along one edge.
struct Plate {
    uint32_t edge = 0;    ///< of the whole footprint, as in edgesOf()
    Footprint footprint;  ///< its part of that edge has the edge's tag; what it shares with others is EdgeSource::Cut
};
/// A footprint taken apart.
struct Plates {
    std::vector<Plate> plates;  ///< in the order of the edges; edges whose neighbours leave them nothing have none
    Footprint core;             ///< offset(−thickness); empty where the plates leave none
};
/// Plates of `thickness_m` inside every edge and the core: together the footprint, and nothing twice. Where every edge
/// has its part of the core's outline plates are trapezoids and O(n log n); else each is cut in turn, O(n²).
/// Error::Input for a thickness that isn't > 0.
Result<Plates> platesOf(const Footprint& footprint, double thickness_m);

/// Plates that follow each other along an outline as one; `closed`: the last one meets the first. Edges keep tags and
/// sources, and those that aren't EdgeSource::Cut are called `outer` as well.
Footprint joined(const std::vector<Plate>& plates, bool closed);

/// What lies within half of `width_m` of a chain of points, with mitred corners and straight ends; `closed`: from the
/// last point back to the first. Edges of the result have the entry of the segment they run along, edges[i] from point
/// i to i + 1. Chains may cross themselves. Error::Input for fewer than two points, points that aren't finite or within
/// 100 km, and a width below 2 mm.
Result<Footprint> band(const Ring& chain, const std::vector<std::string>& tags, double width_m, bool closed);

}  // namespace sgm::plan
