// What pictures tell of the mesh that `sgm build` would write.
// Enters: a model. Leaves: lines on stderr.
#pragma once

#include "cli/requests.h"

namespace sgm::cli {

/// Tells what floats and what is too thin for the cells. Error::Cancelled.
Status warnOfMesh(const Model& model, const MeshedModel& meshed, Context& context);

/// The same of a model whose field is drawn, at these cells. Of a model that holds copies
/// of objects it is told of the ground and of the first object of each start, which `build` meshes apart; of sketched
/// objects and sections nothing.
Status warnAsBuild(const Model& drawn, const ModelRequest& request, const GridRequest& grid, Progress* progress);

}  // namespace sgm::cli
