// The cells of a mesh around parts that are too thin for them.
// Enters: parts that a mesh lacks. Leaves: cells.
#pragma once

#include "grammar/lower/thin_parts.h"
#include "modeler/mesh/cell_set.h"

namespace sgm::lower {

/// How often cells of `cell_m` metres have to be halved until they hold a part.
int halvingsFor(const ThinPart& part, float cell_m);

/// As many cells as addCellsAround looks at.
double countCellsAround(const ThinPart& part, const mesh::Grid& grid);

/// Adds the cells of `grid` whose middles lie within one and a half cells of where a part is missing. O(cells of the
/// box around it).
void addCellsAround(const ThinPart& part, const mesh::Grid& grid, mesh::CellSet& cells);

}  // namespace sgm::lower
