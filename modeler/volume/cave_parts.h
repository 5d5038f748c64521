// The parts of a survey, for cave.cpp: rooms and the best passages between them, floors and ways.
// Enters: air with its clearance. Leaves: their share of a Cave. Assumes the agent was checked.
#pragma once

#include "modeler/volume/cave.h"

namespace sgm::volume {

/// Fills spaces, pockets, rooms, passages and entrances. Gives the space of each voxel, `nowhere` in a pocket.
std::vector<uint32_t> findRooms(const Air& air, Cave& cave);

/// Fills floors, headroom, walkable floor and the longest ways. `spaceOf` as findRooms gives it.
void findWays(const Air& air, const std::vector<uint32_t>& spaceOf, Cave& cave);

}  // namespace sgm::volume
