// Thin walls and narrow gaps that a mesh lacks.
// Enters: a section of a field, and where the mesh has which part. Leaves: what is missing there.
#pragma once

#include <optional>

#include "grammar/lower/presence.h"
#include "grammar/lower/thin_parts.h"
#include "grammar/lower/thin_sections.h"

namespace sgm::lower {

/// The wall or gap at a section where the mesh has neither of its surfaces on more than a tenth of the lines. Cells in
/// metres. O(lines).
std::optional<ThinPart> missingAt(const ThinSection& section, const Presence& presence, double cell_m);

}  // namespace sgm::lower
