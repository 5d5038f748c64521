#include "modeler/mesh/read_formats.h"
#include "modeler/mesh/text_scanner.h"

namespace sgm::mesh {
namespace {

/// "OFF", "COFF", "STCNOFF" …; positions come first with all of these prefixes.
bool isHeader(std::string_view word) {
    for (const std::string_view prefix : {"ST", "C", "N"})
        if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
    return word == "OFF";
}

}  // namespace

Status readOff(std::string_view bytes, TriangleSoup& soup, const Progress* progress) {
    TextScanner text(bytes, '#');
    std::string_view word = text.word();
    if (isHeader(word)) word = text.word();
    if (word == "BINARY") return Error{Error::Kind::Input, "is a binary OFF: save it as text"};
    const auto vertices = numberOf<uint64_t>(word), faces = numberOf<uint64_t>(text.word());
    if (!vertices || !faces)
        return damaged(text.line(), "it begins with OFF and the counts of vertices, faces and edges");
    text.nextLine();  // the edges, which nobody counts
    // "0 0 0\n" and "0\n" are the shortest rows.
    if (*vertices > bytes.size() / 6 + 1 || *faces > bytes.size() / 2 + 1)
        return damaged(0, "it promises more than it holds, or is cut short");

    soup.positions.reserve(*vertices);
    for (uint64_t i = 0; i < *vertices; ++i) {
        if (i % 4096 == 0 && cancelled(progress)) return cancelledError();
        Vec3d& p = soup.positions.emplace_back();
        for (int axis = 0; axis < 3; ++axis) {
            const auto number = numberOf<double>(text.word());
            if (!number) return damaged(text.line(), "a vertex needs three numbers");
            p[axis] = *number;
        }
        text.nextLine();  // normals and colours
    }
    for (uint64_t i = 0; i < *faces; ++i) {
        if (i % 4096 == 0 && cancelled(progress)) return cancelledError();
        const auto corners = numberOf<uint64_t>(text.word());
        if (!corners) return damaged(text.line(), "a face begins with the count of its corners");
        PolygonFan fan(soup);
        for (uint64_t k = 0; k < *corners; ++k) {
            const auto vertex = numberOf<uint32_t>(text.word());
            if (!vertex) return damaged(text.line(), "a face has fewer corners than it says, or one that is no vertex");
            fan.add(*vertex);
        }
        text.nextLine();  // its colour
    }
    return Done{};
}

}  // namespace sgm::mesh
