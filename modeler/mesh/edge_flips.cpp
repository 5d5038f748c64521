#include "modeler/mesh/edge_flips.h"

namespace sgm::mesh {

EdgesBeyond::EdgesBeyond(const FlatMesh& flat, TouchedTriangles& touched, const PageVector<uint32_t>& moveOf) {
    std::vector<bool> isEnd(flat.positions.size());
    for (const TouchedTriangles::Touched& t : touched) {
        const Triangle& c = flat.triangles[t.triangle];
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = c[(i + 1) % 3], b = c[(i + 2) % 3];
            if (moveOf[c[i]] == none || moveOf[a] != none || moveOf[b] != none) continue;
            triangles_.emplace(keyOf(b, a), none);
            isEnd[a] = isEnd[b] = true;
        }
    }
    for (uint32_t t = 0; t < flat.triangles.size(); ++t) {
        const Triangle& c = flat.triangles[t];
        for (int i = 0; i < 3; ++i) {
            if (!isEnd[c[i]] || !isEnd[c[(i + 1) % 3]]) continue;
            if (const auto at = triangles_.find(keyOf(c[i], c[(i + 1) % 3])); at != triangles_.end()) at->second = t;
        }
    }
}

uint32_t EdgesBeyond::triangleWith(uint32_t a, uint32_t b) const {
    const auto at = triangles_.find(keyOf(a, b));
    return at == triangles_.end() ? none : at->second;
}

}  // namespace sgm::mesh
