// Texture coordinates in metres: into which charts a mesh falls, and where a point lies in its chart.
// Enters: a Mesh. Leaves: a chart for each triangle. Assumes the mesh's promises (mesh.h).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::exporter {

/// Directions in which the texture coordinates u (right) and v (up) of a chart grow; unit vectors. They begin where
/// the product with a place is `begin_m`, and are stretched where whole tiles fill a shape.
struct ChartAxes {
    Vec3f u, v;
    std::array<float, 2> begin_m{0, 0}, stretch{1, 1};
    friend bool operator==(const ChartAxes&, const ChartAxes&) = default;
};

/// Charts with their axes; texture coordinates are metres along them, so that charts with the same axes continue each
/// other.
struct TextureCharts {
    std::vector<ChartAxes> axes;       ///< by chart
    std::vector<uint32_t> ofTriangle;  ///< chart, by triangle in mesh order; empty: there are no texture coordinates

    bool empty() const { return ofTriangle.empty(); }
    std::array<float, 2> at(uint32_t chart, Vec3f p) const {
        const ChartAxes& a = axes[chart];
        return {(dot(p, a.u) - a.begin_m[0]) * a.stretch[0], (dot(p, a.v) - a.begin_m[1]) * a.stretch[1]};
    }
};

/// Texture coordinates by the option `uv` of a format. "scope": a flat face is mapped in its own plane, v along what
/// the scope of its shape calls up, so that textures turn with their walls and go on from shape to shape; curved ones
/// are seen along the nearest axis of the scope. They begin where the part's frame says (`lay`). "box": all are seen
/// along the nearest axis of the object. "none".
TextureCharts chartTexture(std::string_view kind, const mesh::Mesh& mesh, const Provenance& provenance);

}  // namespace sgm::exporter
