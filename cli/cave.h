// The cave report of `sgm build --cave`: for whom, as a table, as JSON.
// Enters: a survey. Leaves: text. Assumes metres, Y up.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "modeler/core/result.h"
#include "modeler/volume/cave.h"

namespace sgm::cli {

/// "RADIUS,HEIGHT" or "RADIUS,HEIGHT,SLOPE" in metres and degrees; Error::Usage for anything else.
Result<volume::Agent> parseAgent(const std::string& text);

/// agent, voxel_m, air_m3, spaces, pockets, rooms, passages, entrances, narrowest_m (where there is a passage or an
/// entrance), floor_m2, headroom_m, walkable, longest_path_m, longest_walk_m.
nlohmann::ordered_json caveJson(const volume::Cave& cave);

/// The same as lines to read.
std::string caveTable(const volume::Cave& cave);

}  // namespace sgm::cli
