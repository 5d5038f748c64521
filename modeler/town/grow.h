// Roads grown over maps by a self-sensitive L-system, as paper A says (Scott & Bujnowicz, "Algorithmic Architecture",
// 2010, 3 and appendix A; after Parish & Müller, "Procedural modeling of cities", 2001), with a queue in place of its
// recursion.
// Enters: parameters, and maps as functions of a place. Leaves: a planar graph, connected. Assumes the maps answer the
// same at the same place. Each decision is a function of the place alone: what changes far away changes nothing here,
// as long as it joins no earlier.
#pragma once

#include <functional>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/town/road_graph.h"
#include "modeler/town/road_parameters.h"

namespace sgm::town {

struct OwnStreets;

/// The maps. Functions that are empty answer 1, true, false, false and 0.
struct Land {
    std::function<double(Vec2)> pull;  ///< what highways seek
    std::function<bool(Vec2)> spread;  ///< whether streets grow on from here
    std::function<bool(Vec2)> water, park;
    std::function<double(Vec2)> height;  ///< metres
    /// Weights of the tensor field's parts: along `axis`, about `centre`, along the banks of water, along level lines
    /// of `height`. Empty ones weigh 0; `grid` weighs 1 where all are empty.
    std::function<double(Vec2)> grid, rings, shore, contours;
    const OwnStreets* streets = nullptr;  ///< what is there already: growth begins along them
};

/// What became of streets that were there already.
struct OwnStreetsReport {
    size_t laid = 0;     ///< pieces of the graph
    size_t refused = 0;  ///< pieces that couldn't lie on the lattice without touching another
    size_t apart = 0;    ///< pieces left out because no road joins them to the rest
};

/// The grown graph, its dead ends treated. Error::Budget beyond `limit` pieces, Error::Input where no road can begin,
/// Error::Cancelled.
Result<RoadGraph> growRoads(const RoadParameters& parameters, const Land& land, Progress* progress = nullptr,
                            OwnStreetsReport* report = nullptr);

/// Removes dead ends until there are none but those of own streets.
void pruneEnds(RoadGraph& graph);

}  // namespace sgm::town
