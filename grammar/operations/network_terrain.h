// The hills under a network.
// Enters: the checked roads with their maps. Leaves: shaped ground, and reliefs that lift the network's parts. Assumes
// one network at a time, in this order: survey, grade, then reliefs.
#pragma once

#include <memory>
#include <string>

#include "grammar/derive/parts_context.h"
#include "grammar/rules/grammar.h"
#include "modeler/town/terrain.h"

namespace sgm::operations {

class NetworkTerrain {
public:
    NetworkTerrain(derive::PartsContext& context, const rules::Roads& roads) : context_(context), roads_(roads) {}

    /// Samples the heights, where the roads have some; from then on `land` has the ground with its river beds. False
    /// after a failure.
    bool survey(const town::RoadParameters& parameters, town::Land& land);
    /// Heights for the roads; warns of those that stay too steep.
    void grade(const town::RoadGraph& graph, const town::RoadParameters& parameters);
    /// Why nothing grew, where the ground is to blame; "" where it isn't. Tries roads on level ground.
    std::string obstacle(const town::RoadParameters& parameters, const town::Land& land) const;
    /// The relief of a part of the network, or none on level ground.
    uint32_t reliefOf(const std::string& layer);

private:
    derive::PartsContext& context_;
    const rules::Roads& roads_;
    std::shared_ptr<town::Terrain> terrain_;
    uint32_t reliefs_[3] = {derive::none, derive::none, derive::none};
};

/// Warns of pictures that don't reach the borders of the scope.
void warnOfUncovered(derive::PartsContext& context, const rules::Roads& roads);

}  // namespace sgm::operations
