// Where a mesh lies off the field's surface: cells whose creases and corners it couldn't follow.
// Enters: a model and a crisp mesh of it. Leaves: the parts whose triangles lie off, and where. Assumes a mesh with
// origins and labels whose triangles are no larger than a cell.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"

namespace sgm::lower {

/// Looks at triangles with two corners or more between smooth pieces, where cells have to follow creases: those of
/// which the middle, or that of an edge, is more than a thirtieth of a cell off the surface, by the field, with
/// confined vertices where they belong; an eighth of parts with eaves and mouldings, and of round ones a sixteenth
/// beside what chords are off. Not of what blends, morphs, is clad or displaced. `places` are cubes of a cell around
/// them; `missing` is 0, for the mesh has these parts. Ascending by part, as Rims. Only those `among` others are looked
/// at, where that isn't null. Four evaluations of a shortened tape a triangle, O(triangles of the mesh); `threads` 0:
/// all. Error::Cancelled.
Result<std::vector<ThinPart>> findOffSurface(const derive::Derivation& derivation, const Model& model,
                                             const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                             Progress* progress, const std::vector<ThinPart>* among = nullptr);

}  // namespace sgm::lower
