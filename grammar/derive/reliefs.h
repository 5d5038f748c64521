// Heights that lift what a network laid out on level ground.
// Enters: terrains, and shapes that name a layer of one. Leaves: each layer as a grid that the field reads, and by how
// much each object of its own is lifted. Assumes upright frames. Derivation works on level ground: sizes, joints and
// cuts are those of a flat town, and lowering moves every vertical line up by the height at its foot (field::drape).
#pragma once

#include <memory>

#include "modeler/core/provenance.h"
#include "modeler/field/sampled_grid.h"

namespace sgm::town {
class Terrain;
}

namespace sgm::derive {

struct Derivation;

/// Which heights of a terrain lift a shape.
enum class ReliefLayer : uint8_t { Ground, Deck, Water };

/// A layer of a terrain, over the plan of the scope that the network fills.
struct Relief {
    std::shared_ptr<town::Terrain> terrain;  ///< shared by its layers
    ReliefLayer layer = ReliefLayer::Ground;
    Pose frame;                     ///< of the network's scope
    field::SampledGridPtr heights;  ///< what `finishReliefs` made of it; none where the terrain has no such layer
};

/// Levels the ground below every object that stands on a terrain's ground, shapes the terrains, and notes in Extras by
/// how much each object is lifted. Call once, when no shape will be added or removed any more.
void finishReliefs(Derivation& derivation);

}  // namespace sgm::derive
