// Solids over footprints to convex polyhedra.
// Enters: a SolidValue of a row over a footprint, and its scope. Leaves: disjoint polyhedra in the object's frame.
// Assumes sound footprints.
#pragma once

#include <optional>

#include "grammar/lower/convex_solids.h"

namespace sgm::lower {

/// A block, or a roof that planesOver or roundPlanesOver (plan_planes.h) knows: the formula of its footprint, carried
/// out on convex polyhedra; nothing for other rows, or where it takes too many pieces. `world` bounds it.
std::optional<ConvexContent> convexOverPlan(const derive::SolidValue& solid, const derive::Scope& scope,
                                            derive::ShapeId shape, const Box3d& world,
                                            const derive::Footprints& footprints);

}  // namespace sgm::lower
