// A mesh as bytes, to be compared.
#pragma once

#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

inline std::vector<unsigned char> bytesOf(const Mesh& mesh) {
    std::vector<unsigned char> bytes;
    const auto add = [&](const auto& list) {
        const auto* p = reinterpret_cast<const unsigned char*>(list.data());
        bytes.insert(bytes.end(), p, p + list.size() * sizeof(list[0]));
    };
    for (const Chunk& c : mesh.chunks) {
        add(std::vector<Vec3i>{c.block, {static_cast<int>(c.firstVertex), 0, 0}});
        add(c.positions), add(c.normals), add(c.triangles), add(c.origins), add(c.labels), add(c.ghosts.vertices);
        for (const CornerNormal& n : c.cornerNormals) add(std::vector<CornerNormal>{n});
        for (const ConfinedVertex& v : c.confined) add(std::vector<ConfinedVertex>{v});
    }
    return bytes;
}

}  // namespace sgm::mesh
