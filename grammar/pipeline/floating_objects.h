// Which objects of `place` hang in the air, by boxes, before anything is meshed.
// Enters: a derivation and its objects. Leaves: warnings. Assumes that the objects are derived and none is released.
#pragma once

#include "grammar/pipeline/placed_models.h"

namespace sgm::pipeline {

/// A warning for each line of the grammar whose objects touch nothing that stands: neither the first solid nor what
/// reaches the lowest level, of the model or of the object that holds them, be it by other solids and objects. Boxes
/// decide within 1 mm; what a relief lifts stands on it. O(n log n) plus the pairs that share an interval of an axis.
syntax::Diagnostics floatingObjects(const derive::Derivation& model, const PlacedModels& objects);

}  // namespace sgm::pipeline
