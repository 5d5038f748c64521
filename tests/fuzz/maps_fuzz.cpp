// The readers of outlines, of streets, of maps and of textures. The first byte chooses the format.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "modeler/image/image_file.h"
#include "modeler/plan/read.h"
#include "modeler/town/own_streets.h"
#include "modeler/town/raster.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sgm;
    if (size == 0) return 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] % 6 == 4) {
        const auto streets = town::readStreetsBytes(bytes);
        if (!streets.ok()) {
            if (streets.error().message.empty()) std::abort();
            return 0;
        }
        town::RoadGraph graph;
        town::OwnStreetsReport report;
        town::RoadParameters parameters;
        parameters.block_m = 100;
        town::layStreets(graph, *streets, parameters, {}, report);
        return 0;
    }
    if (data[0] % 6 == 5) {
        const auto file = image::readImageBytes(bytes, {.mostSide = 256});
        const auto pixels = file.ok() ? image::decode(**file) : Result<image::Pixels>(file.error());
        if (pixels.ok() ? pixels->rgba.size() != size_t{pixels->width} * pixels->height
                        : pixels.error().message.empty())
            std::abort();
        return 0;
    }
    if (data[0] % 6 == 3) {
        const auto raster = town::readRasterBytes(bytes, {.mostSide = 256, .mostPixels = 1 << 14});
        if (!raster.ok() && raster.error().message.empty()) std::abort();
        if (raster.ok() &&
            std::max((*raster)->grey.size(), (*raster)->numbers.size()) != size_t{(*raster)->width} * (*raster)->height)
            std::abort();
        return 0;
    }
    constexpr decltype(&plan::readSvg) readers[] = {plan::readGeoJson, plan::readSvg, plan::readObjOutlines};
    const auto features = readers[data[0] % 6](bytes, {}, nullptr);
    if (!features.ok()) {
        if (features.error().message.empty()) std::abort();
        return 0;
    }
    for (const plan::Feature& feature : features->list)
        if (plan::firstFault(feature.footprint)) std::abort();  // what is read is sound
    return 0;
}
