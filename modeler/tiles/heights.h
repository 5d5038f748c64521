// Height maps of a baked ground, as engines import them: 16 bits a sample, a file a square.
// Enters: triangles of cells. Leaves: .r16 (Unreal, little endian) and .png files of n + 1 samples along each side,
// whose border rows are the neighbours' too. Assumes that what counts is the highest surface at each place.
#pragma once

#include <filesystem>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::tiles {

/// Writes heights/X_Z.r16 and .png of every coarsest cell of a baked folder, sampled every `cell_m` of its grid, and
/// heights/heights.json, which says metres a step, height 0 and what lies where. Samples without ground are 0.
/// Error::Input where cells are missing, Error::Cancelled when `progress` says so, between two cells.
Status writeHeights(const std::filesystem::path& folder, Progress* progress = nullptr);

}  // namespace sgm::tiles
