// Shape tree to exact constructive solid geometry: what `lower` makes a field of, as booleans over solids.
// Enters: a Derivation and its Model. Leaves: a field::SolidTree. Assumes that the model was lowered from that
// derivation.
#pragma once

#include "grammar/lower/lower.h"
#include "modeler/field/solid_tree.h"

namespace sgm::lower {

/// The tree whose inside is where the model's field is negative, in the order of the shape tree: each node's own solid,
/// then its children, each joined to what stands so far. Solids keep the origins of the model's provenance. Numbers are
/// the grammar's in double precision; the field rounds each to float. Error::Input, located at the text of the first
/// shape in question, where the model isn't exactly such a tree: blends, morphs and roofs between their two ends,
/// noise, cladding, fractals, meshes from files. O(shapes).
Result<field::SolidTree> solidTree(const derive::Derivation& derivation, const Model& model, Progress* progress);

}  // namespace sgm::lower
