// Parts that add nothing: all that an element of a rule's body makes lies within other solids, or is cut away.
// Enters: a derivation, its model and a mesh of it. Leaves: such elements. Assumes a mesh with origins, before it is
// simplified.
#pragma once

#include <vector>

#include "grammar/lower/lower.h"
#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// The parts that one element of a rule's body made, all of them buried.
struct BuriedParts {
    OriginId first = 0;
    size_t count = 0;
    OriginId cutter = 0;  ///< the part that cuts most of them away; 0 where what buries them stands
};

/// Samples the elements whose parts have no triangle in the mesh and join others by `+` or ',' without a blend: one is
/// buried when its parts own the field nowhere on a lattice through their scopes. Twelve parts of an element and the
/// first 200 such elements are sampled at most. What fills the inside of a hollow block isn't buried, nor is what
/// others bury only together. In the order of the parts; empty for a mesh without origins. O(parts), and 729
/// evaluations of a shortened tape a sampled part. Error::Cancelled.
Result<std::vector<BuriedParts>> findBuriedParts(const derive::Derivation& derivation, const Model& model,
                                                 const eval::Tape& tape, const mesh::Mesh& mesh, Progress* progress);

}  // namespace sgm::lower
