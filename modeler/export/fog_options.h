// The options of fog in files and pictures, read from words.
// Enters: options of the format .vdb, checked. Leaves: what volume::fog takes.
#pragma once

#include "modeler/export/exporter.h"
#include "modeler/volume/fog.h"

namespace sgm::exporter {

/// density, edge, wisps, billow and lump; what isn't given stays as volume::FogOptions has it.
volume::FogOptions fogOptionsOf(const ExportOptions& options);

}  // namespace sgm::exporter
