// Cells of a mesh halved around parts that are too thin for them.
// Enters: a model and its crisp mesh. Leaves: the mesh that holds these parts, as far as it may grow.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/polygonize.h"

namespace sgm::pipeline {

/// Looks for parts, walls that cuts leave, gaps and eaves that a mesh, as it comes from polygonize on `grid`, lacks
/// since they are thinner than its cells, and halves the cells around them up to `options.halvings` times (0 to 3),
/// even where that isn't enough, while the mesh grows, by a guess, to no more than four times its triangles or
/// `options.halvedTriangles`, and for what it has torn a quarter of that more than it has by then: else cells of the
/// parts that take most triangles are halved less often. Where `options.halvesAll` says so and that takes less time,
/// all cells are halved, which adds to `counts`. A model that folds fractals stays as it is, for these have details of
/// any size. Returns the parts of which it still lacks some, eaves where that is half of them, and what it has torn
/// where halving ended at the bound of triangles. Stages "thin parts" and "halve cells".
Result<std::vector<lower::ThinPart>> holdThinParts(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                                                   const mesh::PolygonizeOptions& options, Context& context,
                                                   mesh::Counts& counts);

}  // namespace sgm::pipeline
