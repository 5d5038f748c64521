// Parts thinner than a cell, told of with the resolution that holds them.
// Enters: a model and its mesh. Leaves: lines on stderr.
#pragma once

#include <vector>

#include "cli/requests.h"
#include "grammar/lower/thin_parts.h"

namespace sgm::cli {

/// As lower::findMissingParts, for a mesh as it comes from makeMesh.
Result<std::vector<lower::ThinPart>> findMissingParts(const Model& model, const MeshedModel& meshed, int threads,
                                                      Progress* progress);

/// A warning for each line of the grammar with such parts, the first few of many.
void printMissingParts(const Model& model, const mesh::Grid& grid, const std::vector<lower::ThinPart>& missing);

}  // namespace sgm::cli
