// Nothing floats: which solids hang together, and who made those that don't.
// Enters: a derivation. Leaves: groups of solids by their boxes, and names for messages. What the boxes can't tell, the
// pieces of a mesh can (modeler/mesh/connected_components.h): `sgm build` measures those and names them by the same
// functions.
#pragma once

#include <span>

#include "grammar/derive/derive.h"

namespace sgm::derive {

/// A group number for every shape that adds a solid, counted from 0 in tree order; `none` for all others, cutters too.
/// Solids whose boxes touch within 0.1 mm hang together.
std::vector<uint32_t> touchingGroups(const ShapeTree& tree);

/// By group: true when it neither holds the first solid nor comes down to the lowest level of all.
std::vector<bool> floatingGroups(const ShapeTree& tree, std::span<const uint32_t> groupOf);

/// Stands in `groupOf` for a shape that belongs to several groups.
inline constexpr uint32_t mixedGroups = none - 1;
/// The first shape in tree order all of whose solids are of `group`, as high up as that holds: where the group begins.
/// Where every such shape holds others too, the first that is of the group itself; `none` when there is none.
ShapeId beginOf(const ShapeTree& tree, std::span<const uint32_t> groupOf, uint32_t group);

/// "'House/Storey[3]', made by rule 'Storey' (house.sgm:41)".
std::string madeBy(const Derivation& derivation, ShapeId id);

}  // namespace sgm::derive
