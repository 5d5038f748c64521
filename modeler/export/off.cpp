// OFF, the Object File Format of Geomview (Rowan, 1991): positions and triangles as text.
#include <fmt/format.h>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"

namespace sgm::exporter {

Status writeOff(const ExportInput& input, const Path& temporary, const Path& target) {
    const mesh::Mesh& mesh = *input.mesh;
    const Placement place = placementOf(input);
    OutFile out(temporary, target);
    // Comments would be allowed here, but not every reader skips them.
    out.text(fmt::format("OFF\n{} {} 0\n", mesh.vertexCount(), mesh.triangleCount()));
    if (input.progress) input.progress->begin("write", 2 * mesh.chunks.size());
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (const Vec3f& p : chunk.positions) {
            out.numbers(place.position(p), " ");
            out.text("\n");
        }
        if (!advance(input.progress)) return cancelledError();
    }
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (const mesh::Triangle t : chunk.triangles) {
            out.text("3 ");
            out.numbers(t, " ");
            out.text("\n");
        }
        if (!advance(input.progress)) return cancelledError();
    }
    return out.finish();
}

}  // namespace sgm::exporter
