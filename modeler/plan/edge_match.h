// Which source edges the edges of a result run along, after Clipper has lost their tags. For this folder's sources
// alone. Enters: source edges with the distance each was moved outward. Leaves: tags and sources on the result. Assumes
// that results are off their lines by no more than the lattice's rounding; what matches none takes the nearest.
#pragma once

#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// A source edge, moved `out` metres along its normal, and what edges along it get.
struct SourceEdge {
    Vec2 from, to;
    double out = 0;
    Edge edge;
};

/// Gives every edge of `footprint` the entry of the source it runs along, the first of several. O(n · m).
void matchEdges(Footprint& footprint, const std::vector<SourceEdge>& sources);

/// The footprint's edges as sources, each moved by its own distance (an empty list: 0).
std::vector<SourceEdge> sourcesOf(const Footprint& footprint, const std::vector<double>& out = {});

/// Adds `words` to the footprint's tags; the new number of each.
std::vector<uint32_t> addTags(Footprint& footprint, const std::vector<std::string>& words);

}  // namespace sgm::plan
