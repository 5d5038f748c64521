#include "modeler/volume/isosurface.h"

#include "modeler/mesh/marching_cubes.h"

namespace sgm::volume {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int side = static_cast<int>(Leaf::DIM);

/// The values at the corners of a leaf's cells: one more voxel than the leaf along each axis.
class CellValues {
public:
    /// Reads all voxels. True when not all have the same sign.
    bool read(const openvdb::FloatGrid::ConstAccessor& grid, openvdb::Coord origin) {
        bool inside = false, outside = false;
        size_t n = 0;
        for (int i = 0; i < edge; ++i)
            for (int j = 0; j < edge; ++j)
                for (int k = 0; k < edge; ++k, ++n) {
                    values_[n] = grid.getValue(origin.offsetBy(i, j, k));
                    (values_[n] < 0 ? inside : outside) = true;
                }
        return inside && outside;
    }
    float at(Vec3i v) const { return values_[static_cast<size_t>((v.x * edge + v.y) * edge + v.z)]; }

private:
    static constexpr int edge = side + 1;
    std::array<float, edge * edge * edge> values_;
};

Vec3i cornerOf(Vec3i cell, int c) { return cell + Vec3i{c & 1, c >> 1 & 1, c >> 2 & 1}; }

/// Where the isosurface meets edge `e` of the cell: linear between the edge's ends.
Vec3f crossing(const CellValues& values, Vec3i cell, int e) {
    const int axis = mesh::edgeAxis(e);
    const Vec3i low = cornerOf(cell, mesh::edgeCorner(e));
    Vec3i high = low;
    ++high[axis];
    const float a = values.at(low), b = values.at(high);
    Vec3f p = low.as<float>();
    p[axis] += a / (a - b);
    return p;
}

void addCell(const CellValues& values, Vec3i cell, std::vector<Facet>& facets) {
    unsigned inside = 0;
    for (int c = 0; c < 8; ++c)
        if (values.at(cornerOf(cell, c)) < 0) inside |= 1u << c;
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

LeafSurface isosurface(const openvdb::FloatGrid::ConstAccessor& grid, openvdb::Coord origin) {
    LeafSurface surface;
    CellValues values;
    if (!values.read(grid, origin)) return surface;
    surface.begin.reserve(Leaf::SIZE + 1);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (int k = 0; k < side; ++k) {
                surface.begin.push_back(static_cast<uint16_t>(surface.facets.size()));
                addCell(values, {i, j, k}, surface.facets);
            }
    surface.begin.push_back(static_cast<uint16_t>(surface.facets.size()));
    if (surface.facets.empty()) surface.begin.clear();
    return surface;
}

}  // namespace sgm::volume
