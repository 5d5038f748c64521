#include "modeler/export/origins.h"

#include <fmt/format.h>

#include "modeler/export/formats.h"

namespace sgm::exporter {

std::vector<OriginId> originsOf(const mesh::Mesh& mesh, const Provenance& provenance) {
    std::vector<bool> seen(provenance.parts.size());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins)
            if (origin < seen.size()) seen[origin] = true;
    std::vector<OriginId> origins;
    for (size_t i = 0; i < seen.size(); ++i)
        if (seen[i]) origins.push_back(static_cast<OriginId>(i));
    return origins;
}

std::string originText(const Part& part) {
    const std::string rule = part.rule().empty() ? "" : fmt::format(", rule {}", part.rule());
    const std::string line = part.file().empty() ? "" : fmt::format(", {}:{}", part.file(), part.line());
    return oneLine(part.path.text() + rule + line);
}

std::vector<bool> nodesAbove(const ObjectTree& objects, std::vector<bool> holds) {
    for (size_t i = holds.size(); i-- > 1;)
        if (holds[i]) holds[objects.nodes[i].parent] = true;
    return holds;
}

}  // namespace sgm::exporter
