// Which solids of a mesh float, and which shape each of them began with.
// Enters: a model and its mesh. Leaves: the floating pieces, named. Assumes the mesh carries its origins.
#pragma once

#include <vector>

#include "cli/pipeline.h"
#include "modeler/mesh/pieces.h"

namespace sgm::cli {

struct Floating {
    mesh::Piece piece;
    derive::ShapeId shape = 0;  ///< where the piece begins in the shape tree
};
struct Support {
    uint64_t pieces = 0;  ///< separate solids
    std::vector<Floating> floating;
};
Support supportOf(const Model& model, const mesh::Mesh& mesh, float cell_m);

/// A warning on stderr for each floating piece, the first few of many.
void sayFloating(const Model& model, const Support& support);

/// Drops debris and floating components as `keep` says, and prints what was dropped unless `quiet`.
void keepOnly(mesh::Keep keep, MeshedModel& meshed, int threads, bool quiet);

}  // namespace sgm::cli
