// The borders between regions as polylines.
// Enters: the regions of a surface. Leaves: maximal chains of border edges between nodes, where three or more border
// edges meet, and closed chains without a node. Assumes each border edge is listed once.
#pragma once

#include <span>

#include "modeler/mesh/surface_regions.h"

namespace sgm::mesh {

/// A polyline with one region on its left all along and one on its right. An open chain starts and ends in nodes, maybe
/// in the same one; a closed one has no node and returns from its last vertex to its first.
struct Chain {
    uint32_t begin, end;  ///< in Chains::vertices
    uint32_t left, right;
    bool closed;
};

struct Chains {
    static constexpr uint32_t none = 0xffffffffu;

    std::vector<uint32_t> vertices;  ///< in the mesh, chain after chain
    std::vector<Chain> chains;
    std::vector<uint32_t> placeOf;   ///< by place in SurfaceRegions::borderVertices: in `vertices`; none for a node
    std::vector<uint32_t> chainsOf;  ///< by region, as chainsBegin tells: chains that bound it
    std::vector<uint32_t> chainsOfBegin;  ///< by region and one more

    std::span<const uint32_t> around(uint32_t region) const {
        return {chainsOf.data() + chainsOfBegin[region], chainsOf.data() + chainsOfBegin[region + 1]};
    }
};

/// O(n) in the number of border edges; the order of chains depends on the mesh alone.
Chains findChains(const SurfaceRegions& regions);

}  // namespace sgm::mesh
