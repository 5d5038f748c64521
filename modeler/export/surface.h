// What writers need of a mesh beyond its chunks: vertices by global index, materials by triangle, texture charts, hard
// edges. Enters: a Mesh and its Provenance. Leaves: flat lists in a fixed order. Assumes the mesh's promises (mesh.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/object_tree.h"
#include "modeler/mesh/corners.h"

namespace sgm::exporter {

/// Looks a mesh's vertices up by global index; quick where neighbouring look-ups fall into one chunk.
class Vertices {
public:
    explicit Vertices(const mesh::Mesh& mesh) : mesh_(mesh) {}
    const Vec3f& position(uint32_t v) { return chunkOf(v).positions[v - first()]; }
    const Vec3f& normal(uint32_t v) { return chunkOf(v).normals[v - first()]; }

private:
    uint32_t first() const { return mesh_.chunks[at_].firstVertex; }
    const mesh::Chunk& chunkOf(uint32_t v);

    const mesh::Mesh& mesh_;
    size_t at_ = 0;  ///< chunk of the last look-up
};

/// Index into provenance.materials of the part `origin`; 0 where either is unknown.
uint32_t materialIndex(const Provenance& provenance, OriginId origin);

/// `n` at unit length; +y where it has none.
Vec3f unitNormal(Vec3f n);

/// Eight bits a channel, as colour bytes in files are read.
using Rgb8 = std::array<uint8_t, 3>;
/// A linear colour (clipped to 0 … 1) with the transfer curve of sRGB (IEC 61966-2-1).
Rgb8 srgb(Vec3f linear);

/// Into which patches a mesh is cut.
struct Cut {
    const ObjectTree* objects = nullptr;  ///< null: all are of object 0
    std::span<const uint32_t> charts;     ///< of the mesh's triangles: a vertex is of one; empty: all are of chart 0
    bool byMaterial = true;               ///< else a patch holds all materials of its object
};

/// A run of triangles of one object and one material.
struct Patch {
    uint32_t object = 0;                            ///< node of the object tree
    uint32_t material = 0;                          ///< of all its triangles, or of its first vertex
    uint32_t firstVertex = 0, vertexCount = 0;      ///< in PatchedMesh::vertices
    uint32_t firstTriangle = 0, triangleCount = 0;  ///< in PatchedMesh::triangles
};

/// A mesh cut along hard edges and the borders of objects, materials and charts: a vertex there occurs once per object,
/// material, chart and normal.
struct PatchedMesh {
    std::vector<Patch> patches;             ///< none empty; ascending by object, then material
    std::vector<uint32_t> vertices;         ///< global mesh vertex of each patch vertex
    std::vector<uint32_t> materials;        ///< of each patch vertex
    std::vector<uint32_t> charts;           ///< of each patch vertex
    std::vector<mesh::Triangle> triangles;  ///< corners index `vertices`; ascending by origin within a patch
    std::vector<OriginId> origins;          ///< by triangle
    std::vector<uint32_t> order;            ///< by triangle: its place in the mesh, counted through all chunks
    mesh::CornerNormalTable corners;        ///< of the mesh, its triangles in the mesh's order
    /// By patch vertex: index into corners.normals, or mesh::noIndex where the mesh vertex's own normal holds; empty
    /// where it does for all.
    std::vector<uint32_t> normals;

    /// The unit normal of a patch vertex, of the mesh that was cut.
    Vec3f normal(uint32_t v, Vertices& ofMesh) const;
    /// Patches [begin, end) of one object after the other: where the object of patch `begin` ends.
    size_t endOfObject(size_t begin) const;
};

/// Sorts triangles into patches, stable for triangles of one origin. O(n) in the mesh.
PatchedMesh cutIntoPatches(const mesh::Mesh& mesh, const Provenance& provenance, const Cut& cut);

}  // namespace sgm::exporter
