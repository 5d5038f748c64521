// The tensor field that roads of `pattern = field` follow (Chen et al., "Interactive procedural street modeling",
// 2008). Enters: weights of its parts as functions of the place. Leaves: directions. Assumes that the maps outlive it.
// No libm: the same bits on every machine.
#pragma once

#include "modeler/town/grow.h"

namespace sgm::town {

/// A sum of symmetric traceless tensors: R·(cos 2θ, sin 2θ), where θ is the major direction.
class TensorField {
public:
    TensorField(const RoadParameters& parameters, const Land& land, Vec2 centre)
        : parameters_(parameters), land_(land), centre_(centre) {}

    /// The direction of the field's four at `from` that is nearest to `heading`, corrected by that half a piece on; the
    /// heading itself where the field is degenerate.
    Vec2 direction(Vec2 from, Vec2 heading, double piece_m) const;
    /// The sum at a place: twice the angle of the major direction as a vector of its strength.
    Vec2 at(Vec2 p) const;

private:
    Vec2 nearest(Vec2 p, Vec2 heading) const;
    Vec2 awayFromWater(Vec2 p) const;

    const RoadParameters& parameters_;
    const Land& land_;
    Vec2 centre_;
};

}  // namespace sgm::town
