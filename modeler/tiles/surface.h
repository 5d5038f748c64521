// Triangles as a file of a baked city holds them: a piece a material, ready to be packed.
// Enters: meshes with provenance. Leaves: pieces. Assumes crisp meshes, whose flat parts have flat normals.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"
#include "modeler/mesh/scene.h"

namespace sgm::tiles {

/// Triangles of one material. A vertex has one normal: where creases meet there are several of one position.
struct SurfacePiece {
    uint32_t material = 0;  ///< index into the provenance's materials
    std::vector<Vec3f> positions, normals;
    std::vector<std::array<float, 2>> uvs;  ///< metres to the right and upwards; empty where no picture covers it
    std::vector<Vec3f> tangents;            ///< along the first of those; empty where no normal map covers it
    std::vector<uint32_t> indices;          ///< three a triangle
    uint32_t skirtTriangles = 0;            ///< how many of the last triangles belong to no surface: see addSkirts
};

/// A mesh by material, with its own normals. O(n).
std::vector<SurfacePiece> piecesOf(const mesh::PackedMesh& mesh, const Provenance& provenance);

/// A mesh by material with as few triangles as `error_m` allows, for what is seen from afar: parts aren't told apart,
/// normals are those of the triangles. Borders of materials don't open. O(n log n).
std::vector<SurfacePiece> coarsePiecesOf(const mesh::PackedMesh& mesh, const Provenance& provenance, double error_m);

/// Simplifies the ground's triangles that belong to a cell, which `triangles` names in `mesh`, within a
/// twentieth of `pitch_m`, a cell of the grid that it was meshed on and that has a corner at `centre`; vertices on the
/// cell's border, and those between materials, stay. Positions become those about `centre`; normals are the mesh's
/// where they are nearly those of the triangles.
std::vector<SurfacePiece> groundPieces(const mesh::PackedMesh& mesh, const std::vector<uint32_t>& triangles,
                                       const Provenance& provenance, Vec3d centre, double pitch_m);

/// Of the pieces together.
Box3f boundsOf(const std::vector<SurfacePiece>& pieces);
uint64_t trianglesOf(const std::vector<SurfacePiece>& pieces);

}  // namespace sgm::tiles
