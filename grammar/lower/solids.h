// One evaluated solid to a field in the object's frame.
// Enters: a SolidValue, the scope it fills, the stream key that names its slots. Leaves: a Field. Assumes checked values.
#pragma once

#include <span>

#include "grammar/derive/shape_tree.h"
#include "modeler/field/field.h"

namespace sgm::lower {

/// Slots: (key, "size.x" …) for half-sizes, (key, parameter name) for the solid's own numbers, "morph" for a share;
/// parts of morphs and combinations add their position to the key. `meshes` are the grammar's.
field::Field lowerSolid(field::Graph& graph, const derive::SolidValue& solid, const derive::Scope& scope, uint64_t key,
                        std::span<const field::SampledGridPtr> meshes);

}  // namespace sgm::lower
