// From a model to its mesh and level set.
// Enters: a model, a grid. Leaves: a mesh with the blocks it came from. Assumes a bounded model.
#pragma once

#include <optional>
#include <vector>

#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/volume/volume.h"

namespace sgm::pipeline {

/// A mesh with the grid and blocks it came from.
struct MeshedModel {
    mesh::Grid grid;
    std::vector<mesh::Block> blocks;  ///< of the grid; none of a mesh that was made in the axes of its walls
    mesh::Mesh mesh;
    mesh::Counts counts;
    /// Parts of which the mesh lacks some, for they are too thin for its cells; nothing where that wasn't asked.
    std::optional<std::vector<lower::ThinPart>> missing = {};
};
/// Stages "subdivide", "sample" and "polygonize", on `context.threads` threads whatever `options` say of them; of a
/// crisp mesh whose cells may be halved "thin parts" and "halve cells", see holdThinParts. A crisp mesh of a model
/// whose walls mostly face other directions than the grid is that of the model turned along the grid
/// (derive::facingOf), turned back, from a grid of the same cells; stage "turn". Not so where it holds objects or
/// reliefs, or is cut open.
Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::PolygonizeOptions options,
                             Context& context);

/// Error::Input, located at the start's rule, for a model that has no surface at cells of `cell_m` metres.
Error noSurface(const Model& model, float cell_m);

/// The level set of the model, of the usual narrow band, from the blocks of its mesh, where it has such. Stage "level
/// set".
Result<volume::Volume> levelSet(const Model& model, const MeshedModel& meshed, Context& context);

}  // namespace sgm::pipeline
