#include "modeler/export/lists.h"

namespace sgm::exporter {

Status writeLists(const Lists& lists, const ExportInput& input, const Path& temporary, const Path& target) {
    const mesh::Mesh& mesh = *input.mesh;
    OutFile out(temporary, target, input.progress);
    lists.header(out, mesh.vertexCount(), mesh.triangleCount());
    if (input.progress) input.progress->begin("write", 2 * mesh.chunks.size());
    for (const mesh::Chunk& chunk : mesh.chunks) {
        lists.vertices(out, chunk);
        tick(input.progress);
    }
    for (const mesh::Chunk& chunk : mesh.chunks) {
        lists.triangles(out, chunk);
        tick(input.progress);
    }
    return out.finish();
}

Status streamLists(const Lists& lists, const ExportInput& input, const ChunkSource& chunks, const Path& temporary,
                   const Path& target) {
    OutFile vertices(target, input.progress), triangles(target, input.progress);
    uint64_t vertexCount = 0, triangleCount = 0;
    const Status listed = chunks([&](const mesh::Mesh&, const mesh::Chunk& chunk) -> Status {
        lists.vertices(vertices, chunk);
        lists.triangles(triangles, chunk);
        vertexCount += chunk.positions.size();
        triangleCount += chunk.triangles.size();
        if (vertices.failed()) return vertices.finish();
        if (triangles.failed()) return triangles.finish();
        return Done{};
    });
    if (!listed.ok()) return listed;
    OutFile out(temporary, target, input.progress);
    lists.header(out, vertexCount, triangleCount);
    out.append(vertices);
    out.append(triangles);
    return out.finish();
}

}  // namespace sgm::exporter
