// Parts that lie within others wherever they are, told of with their line.
// Enters: a model and its mesh. Leaves: sentences.
#pragma once

#include <vector>

#include "grammar/pipeline/context.h"
#include "grammar/pipeline/floating.h"

namespace sgm::pipeline {

/// A warning for each element of a rule's body whose parts are all buried (lower::findBuriedParts), the first few of
/// many; the mesh is one as it comes from makeMesh. Error::Cancelled.
Result<std::vector<MeshWarning>> buriedWarnings(const Model& model, const mesh::Mesh& mesh, Context& context);

}  // namespace sgm::pipeline
