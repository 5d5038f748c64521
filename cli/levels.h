// What `sgm build --lod` prints of the levels of detail that it adds.
// Enters: levels. Leaves: text.
#pragma once

#include <string>
#include <vector>

#include "modeler/mesh/levels.h"

namespace sgm::cli {

/// A line a level with its triangles, its tolerance and where it stands for the model, and one for each that has as
/// many triangles as the one before; `finest` is the triangles of level 0.
std::string levelTable(const std::vector<mesh::LevelOfDetail>& levels, size_t finest);

}  // namespace sgm::cli
