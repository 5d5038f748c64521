#include "modeler/mesh/read_formats.h"
#include "modeler/mesh/text_scanner.h"

namespace sgm::mesh {
namespace {

/// "7", "7/1", "7//3" or "-1/…" as a vertex's index from 0; nothing where it is none. Later vertices are possible.
std::optional<uint32_t> vertexOf(std::string_view word, size_t verticesSoFar) {
    const auto number = numberOf<int64_t>(word.substr(0, word.find('/')));
    const auto so = static_cast<int64_t>(verticesSoFar);
    if (!number || *number == 0 || *number < -so || *number > int64_t{std::numeric_limits<uint32_t>::max()}) return {};
    return static_cast<uint32_t>(*number > 0 ? *number - 1 : so + *number);
}

}  // namespace

Status readObj(std::string_view bytes, TriangleSoup& soup, const Progress* progress) {
    TextScanner text(bytes, '#', true);
    for (uint64_t lines = 0; !text.atEnd(); ++lines, text.nextLine()) {
        if (lines % 4096 == 0 && cancelled(progress)) return cancelledError();
        const std::string_view key = text.wordOfLine();
        if (key == "v") {
            Vec3d& p = soup.positions.emplace_back();
            for (int axis = 0; axis < 3; ++axis) {
                const auto number = numberOf<double>(text.wordOfLine());
                if (!number) return damaged(text.line(), "a vertex needs three numbers");
                p[axis] = *number;
            }
        } else if (key == "f") {
            PolygonFan fan(soup);
            for (std::string_view word; !(word = text.wordOfLine()).empty();) {
                const auto vertex = vertexOf(word, soup.positions.size());
                if (!vertex) return damaged(text.line(), "a face has a corner that is no vertex");
                fan.add(*vertex);
            }
        }
    }
    return Done{};
}

}  // namespace sgm::mesh
