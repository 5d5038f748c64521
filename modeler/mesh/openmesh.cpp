#include "modeler/mesh/openmesh.h"

namespace sgm::mesh {
namespace {

/// Face property of type OriginId.
constexpr const char* originProperty = "origin";

OpenMesh::Vec3f fromVec(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3f toVec(const OpenMesh::Vec3f& v) { return {v[0], v[1], v[2]}; }

}  // namespace

HalfEdgeMesh toOpenMesh(const Mesh& mesh) {
    HalfEdgeMesh result;
    const size_t vertices = mesh.vertexCount(), triangles = mesh.triangleCount();
    result.reserve(vertices, vertices + triangles, triangles);
    for (const Chunk& c : mesh.chunks)
        for (size_t i = 0; i < c.positions.size(); ++i)
            result.set_normal(result.add_vertex(fromVec(c.positions[i])),
                              fromVec(c.hasPositionsOnly() ? Vec3f{} : c.normals[i]));
    OpenMesh::FPropHandleT<OriginId> origin;
    result.add_property(origin, originProperty);
    const auto vertex = [](uint32_t v) { return OpenMesh::VertexHandle(static_cast<int>(v)); };
    for (const Chunk& c : mesh.chunks)
        for (size_t i = 0; i < c.triangles.size(); ++i) {
            const Triangle t = c.inMesh(c.triangles[i]);
            const OpenMesh::FaceHandle face = result.add_face(vertex(t.x), vertex(t.y), vertex(t.z));
            if (face.is_valid()) result.property(origin, face) = c.hasPositionsOnly() ? OriginId{0} : c.origins[i];
        }
    result.update_face_normals();
    return result;
}

Mesh fromOpenMesh(const HalfEdgeMesh& mesh, bool keepNormals) {
    Chunk chunk;
    std::vector<uint32_t> number(mesh.n_vertices());
    chunk.positions.reserve(mesh.n_vertices());
    chunk.normals.reserve(mesh.n_vertices());
    chunk.triangles.reserve(mesh.n_faces());
    chunk.origins.reserve(mesh.n_faces());
    for (const OpenMesh::VertexHandle v : mesh.vertices()) {
        number[static_cast<size_t>(v.idx())] = static_cast<uint32_t>(chunk.positions.size());
        chunk.positions.push_back(toVec(mesh.point(v)));
        chunk.normals.push_back(keepNormals ? toVec(mesh.normal(v)) : Vec3f{});
    }
    OpenMesh::FPropHandleT<OriginId> origin;
    const bool hasOrigin = mesh.get_property_handle(origin, originProperty);
    for (const OpenMesh::FaceHandle f : mesh.faces()) {
        Triangle t;
        int corner = 0;
        for (const OpenMesh::VertexHandle v : mesh.fv_range(f)) t[corner++] = number[static_cast<size_t>(v.idx())];
        chunk.triangles.push_back(t);
        chunk.origins.push_back(hasOrigin ? mesh.property(origin, f) : OriginId{0});
        if (keepNormals) continue;
        const Vec3f p = chunk.positions[t.x],
                    n = cross(chunk.positions[t.y] - p, chunk.positions[t.z] - p);  // weighs by area
        for (int i = 0; i < 3; ++i) chunk.normals[t[i]] += n;
    }
    for (Vec3f& n : chunk.normals) n = normalized(n);
    Mesh result;
    result.chunks.push_back(std::move(chunk));
    return result;
}

}  // namespace sgm::mesh
