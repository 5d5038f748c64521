// SVG (.svg) and GeoJSON (.geojson): the plan of a town.
#include "modeler/town/town_plan.h"

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"

namespace sgm::exporter {
namespace {

Status writeText(const ExportInput& input, const std::string& text, const Path& temporary, const Path& target) {
    OutFile out(temporary, target, input.progress);
    out.text(text);
    return out.finish();
}

Status writeSvg(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeText(input, town::svgOf(*input.plan), temporary, target);
}

Status writeGeoJson(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeText(input, town::geoJsonOf(*input.plan), temporary, target);
}

}  // namespace

constinit const Exporter svgFormat{
    .extension = ".svg",
    .doc = "The plan of a town: roads, blocks, lots, water and parks, a group each; metres, north up",
    .options = {},
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeSvg,
    .wantsPlan = true,
};

constinit const Exporter geojsonFormat{
    .extension = ".geojson",
    .doc = "The plan of a town, a feature an area with its layer, key, area and length along streets; metres",
    .options = {},
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeGeoJson,
    .wantsPlan = true,
};

}  // namespace sgm::exporter
