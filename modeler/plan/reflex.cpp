#include "modeler/plan/reflex.h"

namespace sgm::plan {

std::vector<bool> edgesAtReflexCorners(const Footprint& footprint) {
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    std::vector<bool> reflex(edges.size());
    for (size_t i = 0; i < edges.size(); ++i) {
        const Polygon& polygon = footprint.polygons[edges[i].polygon];
        const size_t n = edges[i].ring == 0 ? polygon.outer.size() : polygon.courts[edges[i].ring - 1].size();
        const size_t next = edges[i].index + 1 == n ? i + 1 - n : i + 1;
        if (cross(edges[i].to - edges[i].from, edges[next].to - edges[next].from) <= 0) reflex[i] = reflex[next] = true;
    }
    return reflex;
}

}  // namespace sgm::plan
