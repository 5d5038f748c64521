// Islands of a mesh: parts that lie flat on a plane without covering themselves.
// Enters: a Mesh with the chart of each triangle. Leaves: an island for each triangle. Assumes the mesh's promises
// (mesh.h) and charts that see none of their triangles from behind.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/export/texture.h"

namespace sgm::exporter {

/// Where an island lies on the plane of its chart.
struct Island {
    uint32_t chart = 0;
    uint32_t object = 0;
    std::array<float, 2> lo, hi;  ///< bounds of its texture coordinates, metres
};

struct Islands {
    std::vector<Island> all;           ///< in the order of their first triangles
    std::vector<uint32_t> ofTriangle;  ///< by triangle in mesh order
};

/// Connected triangles of one chart and one object whose projections on the chart's plane don't overlap. `objects` is
/// the object of each triangle, empty for one object. O(n) for charts that are flat, about that for others. What it
/// gives is of no use once the progress is cancelled.
Islands findIslands(const mesh::Mesh& mesh, const TextureCharts& charts, const std::vector<uint32_t>& objects,
                    const Progress* progress);

}  // namespace sgm::exporter
