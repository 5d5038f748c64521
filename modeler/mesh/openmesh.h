// The half-edge view of a mesh, for users of the library; includes OpenMesh, so include it in .cpp files only.
// Enters: a Mesh. Leaves: an OpenMesh triangle mesh with normals and an origin per face.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

struct HalfEdgeTraits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::PrevHalfedge);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<HalfEdgeTraits>;

/// Vertices in mesh order; a face property "origin" (OriginId). Normals and origins of a bare mesh are 0. Faces
/// OpenMesh refuses (non-manifold) are left out.
HalfEdgeMesh toOpenMesh(const Mesh& mesh);
/// Back: one chunk with vertex normals recomputed from faces where `keepNormals` is false.
Mesh fromOpenMesh(const HalfEdgeMesh& mesh, bool keepNormals);

}  // namespace sgm::mesh
