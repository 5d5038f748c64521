#include "modeler/mesh/byte_order.h"
#include "modeler/mesh/read_formats.h"
#include "modeler/mesh/text_scanner.h"

namespace sgm::mesh {
namespace {

constexpr size_t head_bytes = 84, row_bytes = 50;

Status readBinary(std::string_view bytes, uint32_t triangles, TriangleSoup& soup, const Progress* progress) {
    soup.positions.reserve(size_t{3} * triangles);
    soup.triangles.reserve(triangles);
    for (uint32_t t = 0; t < triangles; ++t) {
        if (t % 4096 == 0 && cancelled(progress)) return cancelledError();
        const char* corner = bytes.data() + head_bytes + t * row_bytes + 12;  // behind the normal
        for (int i = 0; i < 3; ++i, corner += 12)
            soup.positions.push_back(
                {numberAt<float>(corner), numberAt<float>(corner + 4), numberAt<float>(corner + 8)});
        soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return Done{};
}

Status readText(std::string_view bytes, TriangleSoup& soup, const Progress* progress) {
    TextScanner text(bytes);
    text.nextLine();  // "solid" and a name, which may be any words
    size_t corners = 0;
    bool ended = false;
    for (uint64_t lines = 0; !text.atEnd(); ++lines, text.nextLine()) {
        if (lines % 4096 == 0 && cancelled(progress)) return cancelledError();
        const std::string_view key = text.wordOfLine();
        if (key == "vertex") {
            Vec3d& p = soup.positions.emplace_back();
            for (int axis = 0; axis < 3; ++axis) {
                const auto number = numberOf<double>(text.wordOfLine());
                if (!number) return damaged(text.line(), "a vertex needs three numbers");
                p[axis] = *number;
            }
            ++corners;
        } else if (key == "endloop") {
            if (corners != 3) return damaged(text.line(), "a facet has three corners");
            const auto last = static_cast<uint32_t>(soup.positions.size() - 1);
            soup.triangles.push_back({last - 2, last - 1, last});
            corners = 0;
        } else if (key == "solid" || key == "endsolid") {
            ended = key == "endsolid";
        }
    }
    if (corners != 0 || !ended) return damaged(text.line(), "it is cut short");
    return Done{};
}

}  // namespace

Status readStl(std::string_view bytes, TriangleSoup& soup, const Progress* progress) {
    if (bytes.size() >= head_bytes) {
        const auto triangles = numberAt<uint32_t>(bytes.data() + 80);
        const size_t wanted = head_bytes + size_t{triangles} * row_bytes;
        // Some binary files begin with "solid" too: their length tells.
        if (wanted == bytes.size() || (!bytes.starts_with("solid") && wanted < bytes.size()))
            return readBinary(bytes, triangles, soup, progress);
    }
    if (bytes.starts_with("solid")) return readText(bytes, soup, progress);
    return damaged(0, "it promises more than it holds, or is cut short");
}

}  // namespace sgm::mesh
