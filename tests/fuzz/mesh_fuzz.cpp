// The mesh readers, and the distances to whatever they accept. The first byte chooses the format.
#include <cstdint>
#include <cstdlib>

#include "modeler/mesh/distances.h"
#include "modeler/mesh/read_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sgm::mesh;
    if (size == 0) return 0;
    constexpr decltype(&readObj) readers[] = {readObj, readOff, readPly, readStl};
    TriangleSoup soup;
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const auto beside = [](const std::string&) { return sgm::Error{sgm::Error::Kind::Input, "it is elsewhere"}; };
    const bool isGltf = data[0] % 5 == 4;
    if (const sgm::Status read =
            isGltf ? readGltf(bytes, beside, soup, nullptr) : readers[data[0] % 5](bytes, soup, nullptr);
        !read.ok()) {
        if (read.error().message.empty()) std::abort();
        return 0;
    }
    const size_t places = isGltf ? 1'000'000 : 0;  // what nodes may repeat
    if (soup.triangles.size() > 13 * size + places || soup.positions.size() > size + places) std::abort();
    if (soup.triangles.size() > 13 * size) return 0;
    if (!checkSoup(soup).ok()) return 0;
    constexpr int cells = 6;
    const auto grid = toDistances(std::move(soup), cells);
    if (!grid.ok() && grid.error().message.empty()) std::abort();
    return 0;
}
