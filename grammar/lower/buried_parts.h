// Parts that add nothing: whatever a place of the grammar makes lies within other solids.
// Enters: a derivation, its model and a mesh of it. Leaves: such places. Assumes a mesh with origins, before it is
// simplified.
#pragma once

#include <vector>

#include "grammar/lower/lower.h"
#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// The parts that one place of a grammar made, all of them buried.
struct BuriedParts {
    OriginId first = 0;
    size_t count = 0;
};

/// Looks at the places whose parts have no triangle in the mesh and join others by `+` or ',' without a blend: does the
/// field's surface belong to one of them anywhere on a lattice through its scope? Up to twelve parts of a place are
/// asked. What fills the inside of a hollow block isn't buried, nor is what others bury only together. In the order of
/// the parts; empty for a mesh without origins. O(parts), and 729 evaluations of a shortened tape a part that is asked.
/// Error::Cancelled.
Result<std::vector<BuriedParts>> findBuriedParts(const derive::Derivation& derivation, const Model& model,
                                                 const eval::Tape& tape, const mesh::Mesh& mesh, Progress* progress);

}  // namespace sgm::lower
