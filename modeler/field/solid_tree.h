// A model as exact constructive solid geometry: booleans over primitives, for programs that work on solids.
// Enters: what lower::solidTree collects. Leaves: flat arrays that writers and tests walk. Assumes children before
// their parents, so that nothing recurses.
#pragma once

#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/field/domain.h"
#include "modeler/field/primitives.h"

namespace sgm::field {

/// One primitive in its place: it fills the box of `size` about `frame`.
struct PlacedSolid {
    const Primitive* primitive = nullptr;  ///< a row of `primitives`; never `roof`, `kifs`, `ornament` or `mesh`
    std::vector<double> arguments;         ///< one number per parameter of the row: metres, radians or plain shares
    Frame frame;                           ///< centre in metres and world-from-local axes, in the object's frame
    Vec3d size{1, 1, 1};                   ///< metres, > 0
    OriginId origin = 0;                   ///< the part that owns the surface which the solid gives or cuts
};

/// A node is a solid or a boolean of nodes that stand before it.
struct SolidNode {
    /// Difference: the first operand less all others. Where two operands share a surface, the first owns it.
    enum class Op : uint8_t { Solid, Union, Difference, Intersection };
    Op op = Op::Solid;
    uint32_t solid = 0;                ///< index into SolidTree::solids, for Op::Solid
    std::vector<uint32_t> operands{};  ///< indices of nodes, two or more, for the others
};

/// A model's solids and how they join. The last node is the whole model.
struct SolidTree {
    std::vector<PlacedSolid> solids;
    std::vector<SolidNode> nodes;
    Box3d bounds;  ///< holds the model, in metres; half-spaces may be cut to a box around it
};

}  // namespace sgm::field
