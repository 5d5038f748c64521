// The objects of docs/gallery.md, measured without their noise beside what the project asks of each family.
// Enters: the list that docs/gallery.sh draws from. Leaves: a section of the page. Assumes the repository's root as the
// working folder.
#pragma once

#include <string>

#include "tests/bench/measure.h"

namespace sgm::bench {

/// Markdown: every cave, cloud and building of the list at 256 cells, the times from field to mesh and the goals (a
/// tenth of the times in SG-M, table 1). Error::Input when the list or a grammar can't be read.
Result<std::string> galleryTimes(const std::string& list, const MeasureOptions& options);

}  // namespace sgm::bench
