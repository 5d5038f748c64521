// Caves in `sgm build`: the survey, its report as a table and as JSON, and the floor.
// Enters: a level set and its mesh. Leaves: text and a mesh. Assumes metres, Y up.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "grammar/pipeline/model.h"
#include "modeler/core/result.h"
#include "modeler/export/exporter.h"
#include "modeler/volume/cave.h"

namespace sgm::cli {

/// "RADIUS,HEIGHT" or "RADIUS,HEIGHT,SLOPE" in metres and degrees; Error::Usage for anything else.
Result<volume::Agent> parseAgent(const std::string& text);

/// What `--cave` and `--floor` ask for.
struct SurveyRequest {
    std::string agent;  ///< as `parseAgent` reads it, "" for the usual one
    std::string floor;  ///< the file for the walkable floor, "" for none
    bool flipNormals = false;
    volume::FloorFilter isFloor = {};  ///< none: all that isn't too steep
};
/// A cave, and its walkable floor where that is wanted.
struct Survey {
    volume::Cave cave;
    mesh::Mesh floor;
};
/// Refuses the surfaces of shapes that say `walk none`, by themselves or by what they stand in; empty where none does.
volume::FloorFilter floorFilter(const pipeline::Model& model);
/// Surveys the input's volume and mesh; Error::Input when a floor is wanted and there is none.
Result<Survey> surveyFor(const SurveyRequest& request, const exporter::ExportInput& input);
/// Writes the floor as a model of its own.
Status writeFloor(const std::string& file, exporter::ExportInput input, const mesh::Mesh& floor);

/// agent, voxel_m, air_m3, spaces, pockets, rooms, passages, entrances, narrowest_m (where there is a passage or an
/// entrance), floor_m2, headroom_m, walkable, longest_path_m, longest_walk_m.
nlohmann::ordered_json caveJson(const volume::Cave& cave);

/// The same as lines to read.
std::string caveTable(const volume::Cave& cave);

}  // namespace sgm::cli
