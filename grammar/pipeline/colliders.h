// The colliders that `sgm build --collider` adds.
// Enters: a model and its mesh. Leaves: colliders for the exporter. Assumes a kind that `checkOutputs` let pass.
#pragma once

#include <string>
#include <vector>

#include "grammar/pipeline/model.h"
#include "modeler/export/colliders.h"

namespace sgm::pipeline {

struct Colliders {
    std::vector<exporter::Collider> all;
    std::vector<std::string> notes;  ///< where they aren't what is seen, a line each
};

/// "boxes" or "convex" from the model's terminals, "mesh" from the mesh, decimated. The errors of
/// lower::convexParts and mesh::simplify.
Result<Colliders> makeColliders(const std::string& kind, const Model& model, const mesh::Mesh& mesh,
                                Progress* progress);

}  // namespace sgm::pipeline
