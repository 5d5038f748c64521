// A second set of texture coordinates in which no two triangles of an object overlap, for light maps and bakes.
// Enters: a Mesh with charts. Leaves: the same charts cut into islands, and where each island lies on the map. Assumes
// the mesh's promises (mesh.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "modeler/core/object_tree.h"
#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/export/texture.h"

namespace sgm::exporter {

/// Where islands lie on their object's map, a square of 0 … 1.
class LightMap {
public:
    /// Replaces `charts` by its islands. Each object has a map of its own, `texels` a side, which its islands fill at
    /// one scale with two texels between them. Error::Input where an object has more islands than its map has room for,
    /// Error::Cancelled.
    static Result<LightMap> make(const mesh::Mesh& mesh, const ObjectTree* objects, int texels, Progress* progress,
                                 TextureCharts& charts);

    /// Of a point of the island: u to the right, v up, never mirrored.
    std::array<float, 2> at(uint32_t island, Vec3f p) const;

private:
    struct Place {
        ChartAxes axes;      ///< turned as the island lies
        float u = 0, v = 0;  ///< of the map, where its chart's origin lies
        float scale = 1;     ///< of the map a metre
    };
    std::vector<Place> places_;  ///< by island
};

}  // namespace sgm::exporter
