// OFF, the Object File Format of Geomview (Rowan, 1991): positions and triangles as text.
#include <fmt/format.h>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"

namespace sgm::exporter {

Status writeOff(const ExportInput& input, const Path& temporary, const Path& target) {
    const mesh::Mesh& mesh = *input.mesh;
    const Placement place = placementOf(input);
    OutFile out(temporary, target, input.progress);
    // Comments would be allowed here, but not every reader skips them.
    out.text(fmt::format("OFF\n{} {} 0\n", mesh.vertexCount(), mesh.triangleCount()));
    if (input.progress) input.progress->begin("write", 2 * mesh.chunks.size());
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (const Vec3f& p : chunk.positions) {
            if (out.failed()) break;
            out.numbers(place.position(p), " ");
            out.text("\n");
        }
        tick(input.progress);
    }
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (const mesh::Triangle t : chunk.triangles) {
            if (out.failed()) break;
            out.text("3 ");
            out.numbers(chunk.inMesh(t), " ");
            out.text("\n");
        }
        tick(input.progress);
    }
    return out.finish();
}

}  // namespace sgm::exporter
