// Shape tree to field.
// Enters: a Derivation. Leaves: a Model: graph, field and the provenance behind its origins. Assumes a finite tree.
// The field of a node is its own solid combined with its children in order, so a difference cuts what its own node
// holds so far and nothing else. Slots are keyed by (shape key, attribute).
#pragma once

#include "grammar/derive/derive.h"
#include "modeler/core/provenance.h"
#include "modeler/field/field.h"

namespace sgm::lower {

struct Model {
    field::Graph graph;
    field::Field field;                    ///< a node of `graph`
    Provenance provenance;                 ///< parts[id] for every origin in the field
    std::vector<derive::ShapeId> shapeOf;  ///< by OriginId; none for 0
};

/// Gives every part below a shape that is laid (`lay`), or whose own texture fits, the frame that its textures begin
/// at. O(parts · depth) where a material has a texture, else nothing.
void layTextures(const derive::Derivation& derivation, Model& model);

/// Fails when the solid is unbounded, or when nothing solid is left of a derivation that holds no objects of their own:
/// they aren't part of the field (derive::graft makes them so).
/// On `threads` threads, 0 for all that the machine has, of which nothing shows in the model. `joinsBoxes`: boxes of
/// one material that stand side by side in a sum become one, which has the origin of the first: for meshes that
/// need no origin a part.
Result<std::unique_ptr<Model>> lower(const derive::Derivation& derivation, Progress* progress, int threads = 0,
                                     bool joinsBoxes = false);

}  // namespace sgm::lower
