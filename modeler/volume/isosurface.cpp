#include "modeler/volume/isosurface.h"

#include <algorithm>

#include "modeler/mesh/marching_cubes.h"

namespace sgm::volume {
namespace {

float at(const CornerValues& values, Vec3i v) {
    return values[static_cast<size_t>((v.x * cellCorners + v.y) * cellCorners + v.z)];
}

Vec3i cornerOf(Vec3i cell, int c) { return cell + Vec3i{c & 1, c >> 1 & 1, c >> 2 & 1}; }

/// Where the isosurface meets edge `e` of the cell: linear between the edge's ends.
Vec3f crossing(const CornerValues& values, Vec3i cell, int e) {
    const int axis = mesh::edgeAxis(e);
    const Vec3i low = cornerOf(cell, mesh::edgeCorner(e));
    Vec3i high = low;
    ++high[axis];
    const float a = at(values, low), b = at(values, high);
    Vec3f p = low.as<float>();
    p[axis] += a / (a - b);
    return p;
}

void addCell(const CornerValues& values, Vec3i cell, std::vector<Facet>& facets) {
    unsigned inside = 0;
    for (int c = 0; c < 8; ++c)
        if (at(values, cornerOf(cell, c)) < 0) inside |= 1u << c;
    if (inside == 0 || inside == 255) return;
    const mesh::CellCase& made = mesh::caseTable()[inside];
    for (size_t t = 0; t < made.triangles; ++t) {
        Facet facet;
        for (size_t corner = 0; corner < 3; ++corner)
            facet.corners[corner] = crossing(values, cell, made.edges[3 * t + corner]);
        facet.normal = normalized(cross(facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]));
        facets.push_back(facet);
    }
}

}  // namespace

LeafSurface isosurface(const CornerValues& values) {
    LeafSurface surface;
    const auto inside = std::count_if(values.begin(), values.end(), [](float v) { return v < 0; });
    if (inside == 0 || inside == static_cast<std::ptrdiff_t>(values.size())) return surface;
    surface.begin.reserve(leafVoxels * leafVoxels * leafVoxels + 1);
    for (int i = 0; i < leafVoxels; ++i)
        for (int j = 0; j < leafVoxels; ++j)
            for (int k = 0; k < leafVoxels; ++k) {
                surface.begin.push_back(static_cast<uint16_t>(surface.facets.size()));
                addCell(values, {i, j, k}, surface.facets);
            }
    surface.begin.push_back(static_cast<uint16_t>(surface.facets.size()));
    if (surface.facets.empty()) surface.begin.clear();
    return surface;
}

}  // namespace sgm::volume
