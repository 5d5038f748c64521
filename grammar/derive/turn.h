// The direction that a model's walls face, and a model turned about the y axis.
// Enters: a derivation. Leaves: an angle; a derivation whose shapes stand elsewhere. Assumes nothing.
#pragma once

#include "grammar/derive/derive.h"

namespace sgm::derive {

/// The rotation about the y axis, right-handed, from the axes of the model to those of its walls, by the least of
/// four angles that will do, radians in [−π/4, π/4]. Walls are the upright sides of boxes and edges of footprints
/// that hold solids. 0 where no more than half of their area agrees within a microradian. O(s log s) in sides and
/// edges.
double facingOf(const Derivation& derivation);

/// The derivation with all its shapes turned about the y axis through the origin, right-handed, by `angle` radians.
/// Axes that come to lie along those of the model do so exactly, and places that are equal but for rounding are equal.
/// What objects, towns and reliefs hold isn't turned: for derivations without them. O(shapes).
Derivation turned(const Derivation& derivation, double angle);

}  // namespace sgm::derive
