#include "modeler/export/texture.h"

#include "modeler/export/surface.h"

namespace sgm::exporter {

TextureCharts chartTexture(std::string_view kind, const mesh::Mesh& mesh) {
    TextureCharts charts;
    if (kind == "none") return charts;
    // As boxProjection: u to the right and v up, seen against each of the six axes.
    charts.axes = {{{0, 0, -1}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, -1}},
                   {{1, 0, 0}, {0, 0, 1}},  {{1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {0, 1, 0}}};
    Vertices vertices(mesh);
    charts.ofTriangle.reserve(mesh.triangleCount());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const mesh::Triangle& local : chunk.triangles) {
            const mesh::Triangle t = chunk.inMesh(local);
            const Vec3f a = vertices.position(t.x), b = vertices.position(t.y), c = vertices.position(t.z);
            charts.ofTriangle.push_back(static_cast<uint32_t>(facing(cross(b - a, c - a))));
        }
    return charts;
}

}  // namespace sgm::exporter
