// The levels of detail that `sgm build --lod` adds.
// Enters: a model and its mesh. Leaves: coarser ones for the exporter, and what is printed of them.
#pragma once

#include <string>
#include <vector>

#include "cli/pipeline.h"
#include "modeler/mesh/levels.h"
#include "modeler/mesh/pieces.h"

namespace sgm::cli {

/// How the mesh of a model became level 0.
struct LevelRequest {
    int count = 1;  ///< the finest included
    float cell_m = 0;
    mesh::PolygonizeOptions meshing;
    mesh::Keep keep = mesh::Keep::All;
    bool inward = false;
};

/// The coarser levels of a model whose mesh is `finest`; none where the request has one level. The errors of
/// mesh::makeLevels.
Result<std::vector<mesh::LevelOfDetail>> makeLevels(const LevelRequest& request, const Model& model,
                                                    const mesh::Mesh& finest, Progress* progress);

/// A line a level with its triangles, its tolerance and where it stands for the model, and one for each that has as
/// many triangles as the one before; `finest` is the triangles of level 0.
std::string levelTable(const std::vector<mesh::LevelOfDetail>& levels, size_t finest);

}  // namespace sgm::cli
