// Walls thinner than a mesh's cells, of any plan and slope: those of shells, and beside cuts that aren't boxes.
// Enters: a derivation, its model and a mesh of it. Leaves: the walls that miss surface. Assumes a mesh with origins
// whose triangles are no larger than a cell.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"

namespace sgm::lower {

/// Follows lines through the scopes of shells and cuts, about a cell of `cell_m` metres apart (at most 256 along each
/// axis), to the field's surface where that is the part's; from there into the solid, straight from the surface. Where
/// air is nearer than cells hold, the mesh has to have a triangle about there: the parts around which it has none at
/// three lines or more, of cuts at a twentieth of their surface. `missing` is a share of a shell's surface, without
/// what ends in a wedge, or of the thin walls beside a cut. Ascending by part. Only those `among` others are looked at,
/// where that isn't null. 1,000 to 30,000 evaluations of a shortened tape a part, O(triangles of the mesh); `threads`
/// 0: all. Error::Cancelled.
Result<std::vector<ThinPart>> findMissingWalls(const derive::Derivation& derivation, const Model& model,
                                               const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m,
                                               int threads, Progress* progress, const std::vector<ThinPart>* among);

}  // namespace sgm::lower
