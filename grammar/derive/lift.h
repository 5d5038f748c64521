// By how much hills lift a shape.
// Enters: a derivation. Leaves: metres. Assumes that it is finished.
#pragma once

#include "grammar/derive/derive.h"

namespace sgm::derive {

/// The height of the relief above a shape, at the middle of its scope; 0 where none lifts it. O(depth).
double liftOf(const Derivation& derivation, ShapeId shape);
/// The shape's scope where it stands on its hills.
Scope liftedScope(const Derivation& derivation, ShapeId shape);

}  // namespace sgm::derive
