// Eaves and mouldings thinner than a mesh's cells: what of a solid over a plan stands out beyond its outline.
// Enters: a derivation, its model and a mesh of it. Leaves: the roofs whose eaves, and the mouldings, that the mesh
// lacks or has torn. Assumes a mesh with origins whose triangles are no larger than a cell.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"

namespace sgm::lower {

/// How far a roof's eaves stand out, metres; 0 of what has none.
double overhangOf(const derive::SolidValue& solid);

/// Looks at the surface of mouldings and of roofs with an overhang of an eighth of a cell or more, where upright lines
/// about a cell apart (at most 32 along an edge of the plan) meet it from below and from above: those from which the
/// mesh is away in three places or more, and in 5 % of them, in 30 % of eaves that are wedges. Away is farther than
/// three sixteenths of a cell, or two fifths of what stands out. `missing` is that share, `thickness_m` about that of
/// the eaves near the wall, or of the moulding, which is a Part, `places` are the edges where that is so. Ascending by
/// part. Only those `among` others are looked at, where that isn't null. Some 1,000 evaluations of a shortened tape an
/// edge, O(triangles of the mesh); `threads` 0: all. Error::Cancelled.
Result<std::vector<ThinPart>> findTornEaves(const derive::Derivation& derivation, const Model& model,
                                            const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                            Progress* progress, const std::vector<ThinPart>* among = nullptr);

}  // namespace sgm::lower
