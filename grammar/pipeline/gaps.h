// Why a solid floats: a gap and how wide it is, parts that meet by less than a cell, or one that is too thin to show.
// Enters: a model, its mesh and its floating pieces. Leaves: a cause for each. Assumes the mesh carries its origins.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/floating.h"

namespace sgm::pipeline {

/// Finds the causes of the first few floating pieces and puts them into `support`. A gap is measured between the
/// nearest points of the mesh; `missing` are the parts that the mesh lacks at cells of `cell_m`. About .1 s for a
/// million triangles. Error::Cancelled.
Status findCauses(const Model& model, const mesh::Mesh& mesh, float cell_m, const std::vector<lower::ThinPart>& missing,
                  Support& support, Progress* progress);

/// "1 m from 'House/Storey' (house.sgm:4) at (0.00, 4.50, 0.00)" and the like, for a message behind a colon; empty
/// where no cause was found.
std::string causeText(const Model& model, const FloatCause& cause, float cell_m);

}  // namespace sgm::pipeline
