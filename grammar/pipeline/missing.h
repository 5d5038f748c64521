// Parts, walls and gaps thinner than a cell, told of with the resolution that holds them.
// Enters: a model and its mesh. Leaves: sentences.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/meshing.h"

namespace sgm::pipeline {

/// The parts that a mesh, as it comes from makeMesh, lacks: what is known of that, or as lower::findMissingParts.
Result<std::vector<lower::ThinPart>> findMissingParts(const Model& model, const MeshedModel& meshed, int threads,
                                                      Progress* progress);

/// A warning for each line of the grammar with such parts, those that lack most volume first, and the first few of
/// many. `object` names the object of `place` that the model is, whose cells are set by --object-cell; empty for the
/// whole model.
std::vector<MeshWarning> missingWarnings(const Model& model, const mesh::Grid& grid,
                                         const std::vector<lower::ThinPart>& missing, const std::string& object = {});

/// Looks at a mesh as it comes from makeMesh for what floats, why, for what is buried and what is too thin: what every
/// command and the window tell alike. Error::Cancelled.
Result<std::vector<MeshWarning>> meshWarnings(const Model& model, const MeshedModel& meshed, Context& context);
/// What meshWarnings() says where the parts that the mesh lacks are known: `missing` is what findMissingParts() gave.
Result<std::vector<MeshWarning>> meshWarnings(const Model& model, const mesh::Mesh& mesh, const mesh::Grid& grid,
                                              const std::vector<lower::ThinPart>& missing, Context& context);

}  // namespace sgm::pipeline
