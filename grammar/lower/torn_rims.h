// Parts that are thick, but stand out of others by less than a mesh's cells hold: rims around arches and windows.
// Enters: a derivation, its model and a mesh of it. Leaves: the parts whose surface the mesh has torn. Assumes a mesh
// with origins whose triangles are no larger than a cell.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"

namespace sgm::lower {

/// Of blocks, round parts and what stands over a plan, as mouldings, that don't blend into others, those that the mesh
/// shows in strips narrower than two cells, or not at all, and from which it is away in three places or more, and in 5
/// % of those where lines through the scope, about a cell apart, meet their surface. `missing` is that share, `places`
/// are all of those. What is thin as a whole is left to findMissingParts and findTornParts. Ascending by part. Only
/// those `among` others are looked at, where that isn't null. Some 1,000 evaluations of a shortened tape a part in
/// strips, O(triangles of the mesh); `threads` 0: all. Error::Cancelled.
Result<std::vector<ThinPart>> findTornRims(const derive::Derivation& derivation, const Model& model,
                                           const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                           Progress* progress, const std::vector<ThinPart>* among = nullptr);

}  // namespace sgm::lower
