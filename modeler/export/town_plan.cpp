// SVG (.svg) and GeoJSON (.geojson): the plan of a town.
#include "modeler/town/town_plan.h"

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"

namespace sgm::exporter {
namespace {

/// Writes the plan by one of town's writers.
template <auto write>
Status writePlan(const ExportInput& input, const Path& temporary, const Path& target) {
    OutFile out(temporary, target, input.progress);
    write(*input.plan, [&](std::string_view piece) { out.text(piece); });
    return out.finish();
}

}  // namespace

constinit const Exporter svgFormat{
    .extension = ".svg",
    .doc = "The plan of a town: roads, blocks, lots, water and parks, a group each; metres, north up",
    .options = {},
    .takesPositionsOnly = saysPositionsOnly,
    .write = writePlan<town::writeSvg>,
    .wantsPlan = true,
};

constinit const Exporter geojsonFormat{
    .extension = ".geojson",
    .doc = "The plan of a town, a feature an area with its layer, key, area and length along streets; metres",
    .options = {},
    .takesPositionsOnly = saysPositionsOnly,
    .write = writePlan<town::writeGeoJson>,
    .wantsPlan = true,
};

}  // namespace sgm::exporter
