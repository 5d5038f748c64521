// One evaluated solid to a field in the object's frame.
// Enters: a SolidValue, the scope it fills, the stream key that names its slots. Leaves: a Field. Assumes checked
// values.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "grammar/derive/shape_tree.h"
#include "grammar/lower/shared_plans.h"
#include "modeler/field/facade.h"

namespace sgm::lower {

/// Whether the solid is the box of its scope.
bool isScopesBox(const derive::SolidValue& solid);
/// The numbers of a scope's box, as field::Graph::boxAttributes names them.
std::array<float, 6> boxNumbers(const derive::Scope& scope);
/// What `value`, the distance to a scope's box, is a field of.
field::Field boxField(field::NodeRef value, const derive::Scope& scope);

/// The footprint that a solid stands over in its scope; none where it has none or doesn't ask for it.
std::optional<PlacedPlan> planUnder(const derive::SolidValue& solid, const derive::Scope& scope);

/// Slots: (key, "size.x" …) for half-sizes, (key, parameter name) for the solid's own numbers, "morph" for a share;
/// parts of morphs and combinations add their position to the key. Slots of a
/// rotation are under `rotationKey`: parts of a building that share its axes share them. `plans` are of the tree's
/// footprints, `meshes` the grammar's.
field::Field lowerSolid(field::Graph& graph, const derive::SolidValue& solid, const derive::Scope& scope, uint64_t key,
                        uint64_t rotationKey, SharedPlans& plans, std::span<const field::SampledGridPtr> meshes);
/// `what` dressed with an ornament that lies in `scope`.
field::Field lowerClad(field::Graph& graph, const field::Clad& what, const derive::SolidValue& ornament,
                       const derive::Scope& scope, uint64_t key);

/// In which cell of its facade a place on a shape is: that of the nearest clad shape, itself or above; none without
/// one.
std::optional<field::FacadeCell> facadeCellAt(const derive::ShapeTree& tree, derive::ShapeId shape, Vec3d p);

/// The details of the ornament that clads a shape; none for a shape that isn't clad. O(shapes below).
std::optional<field::FacadeDetail> facadeDetailOf(const derive::ShapeTree& tree, derive::ShapeId shape);

}  // namespace sgm::lower
