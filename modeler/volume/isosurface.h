// The isosurface in the cells of one leaf, as triangles. No OpenVDB here.
// Enters: the values at the cells' corners. Leaves: the triangles of marching cubes over linear interpolation, in
// voxels from the leaf's origin. Assumes finite values.
#pragma once

#include <array>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/volume/band.h"

namespace sgm::volume {

inline constexpr int cellCorners = leafVoxels + 1;  ///< along an edge of a leaf: one voxel more than the leaf has
/// The values of a leaf and of the voxels next to it on the high sides, (i, j, k) at (i · 9 + j) · 9 + k.
using CornerValues = std::array<float, cellCorners * cellCorners * cellCorners>;

/// A triangle and its unit normal; a normal of length 0 where it has no area.
struct Facet {
    std::array<Vec3f, 3> corners;
    Vec3f normal;
};

/// The triangles in the cells of one leaf; cell (i, j, k) reaches from voxel (i, j, k) to (i + 1, j + 1, k + 1).
struct LeafSurface {
    std::vector<Facet> facets;    ///< cell by cell, cell (i, j, k) at (i · 8 + j) · 8 + k
    std::vector<uint16_t> begin;  ///< first facet of every cell and the end of the last; empty where no cell has any
};

/// The triangles where the values, negative inside, cross zero.
LeafSurface isosurface(const CornerValues& values);

}  // namespace sgm::volume
