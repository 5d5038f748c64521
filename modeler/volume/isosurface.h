// The isosurface of a level set as triangles, leaf by leaf. Includes OpenVDB: for this room's .cpp files only.
// Enters: a grid of floats. Leaves: the triangles of marching cubes over linear interpolation, in voxels from the
// leaf's origin.
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::volume {

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

/// The zero isosurface in the cells of the leaf at `origin`; negative values are inside. Reads a voxel beyond the leaf.
LeafSurface isosurface(const openvdb::FloatGrid::ConstAccessor& grid, openvdb::Coord origin);

}  // namespace sgm::volume
