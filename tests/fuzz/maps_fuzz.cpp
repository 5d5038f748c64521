// The readers of outlines and of pictures. The first byte chooses the format.
#include <cstdint>
#include <cstdlib>

#include "modeler/plan/read.h"
#include "modeler/town/raster.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sgm;
    if (size == 0) return 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] % 4 == 3) {
        const auto raster = town::readRasterBytes(bytes, {.mostSide = 256, .mostPixels = 1 << 14});
        if (raster.ok() ? (*raster)->grey.size() != (*raster)->color.size() : raster.error().message.empty())
            std::abort();
        return 0;
    }
    constexpr decltype(&plan::readSvg) readers[] = {plan::readGeoJson, plan::readSvg, plan::readObjOutlines};
    const auto features = readers[data[0] % 4](bytes, {}, nullptr);
    if (!features.ok()) {
        if (features.error().message.empty()) std::abort();
        return 0;
    }
    for (const plan::Feature& feature : features->list)
        if (plan::firstFault(feature.footprint)) std::abort();  // what is read is sound
    return 0;
}
