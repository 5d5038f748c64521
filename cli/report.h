// The figures of one build, as JSON.
// Enters: what each stage made and counted. Leaves: text. Assumes a mesh was made.
#pragma once

#include <optional>
#include <string>

#include "cli/requests.h"
#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/scene.h"
#include "modeler/mesh/validate.h"
#include "modeler/volume/cave.h"

namespace sgm::cli {

/// stages, shapes, terminals, bonds, rules_applied, field, mesh, placed where `place` puts objects (their number,
/// places, triangles at all places), pieces, floating, missing, reports (of objects at
/// all places too), cave where it was surveyed, peak_memory_bytes, threads, seed.
std::string reportJson(const Model& model, const MeshedModel& meshed, const mesh::MeshFigures& figures,
                       const pipeline::MadeScene& made, const Support& support,
                       const std::vector<lower::ThinPart>& missing, const std::optional<volume::Cave>& cave,
                       const Stages& stages, int threads);

}  // namespace sgm::cli
