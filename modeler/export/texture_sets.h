// The sets of texture coordinates that a file holds.
// Enters: what is to be exported, with the options `uv` and `lightmap`. Leaves: charts, and a light map where one is
// asked for.
#pragma once

#include <optional>

#include "modeler/export/exporter.h"
#include "modeler/export/lightmap.h"
#include "modeler/export/texture.h"

namespace sgm::exporter {

struct TextureSets {
    TextureCharts charts;           ///< empty: no texture coordinates at all
    std::optional<LightMap> light;  ///< the second set, where asked for; charts are islands of it then

    bool empty() const { return charts.empty(); }
};

/// By the options of the input. Error::Usage for a light map without texture coordinates; the errors of LightMap.
Result<TextureSets> makeTexture(const ExportInput& input);

}  // namespace sgm::exporter
