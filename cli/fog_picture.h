// Fog for pictures: the usual one, or that of a .vdb file by its options.
// Enters: a model, a grid, options. Leaves: what draws the fog. Assumes options that were checked.
#pragma once

#include <string>
#include <vector>

#include "cli/requests.h"
#include "modeler/export/exporter.h"
#include "viewer/render/draw.h"

namespace sgm::cli {

/// Error::Input where this program has no OpenVDB, which fog needs; the errors of volume::load.
Status checkFog();

/// "NAME=VALUE" each, of those options of .vdb files that shape fog; Error::Usage names what isn't one.
Result<exporter::ExportOptions> fogOptions(const std::vector<std::string>& words);

/// Fog in the model's place; `words` as above, none for the usual fog with billows; extinction 0: by the model's size.
Result<render::FogPainter> fogPainter(const Model& model, const Box3f& bounds, const GridRequest& cells,
                                      const std::vector<std::string>& words, double extinction_per_m,
                                      Progress* progress);

}  // namespace sgm::cli
