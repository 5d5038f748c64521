// STL, binary (3D Systems, StereoLithography Interface Specification, 1989): triangles with positions only.
#include <algorithm>
#include <cstring>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {

/// Triangles with two equal corners are left out: the format matches corners by position, and without such a triangle
/// its two neighbours still meet in one edge.
static Status streamStl(const ExportInput& input, const ChunkSource& chunks, const Path& temporary,
                        const Path& target) {
    const Placement place = placementOf(input);
    OutFile out(temporary, target, input.progress);
    char header[80] = {};  // must not begin with "solid"
    const std::string title = "sgm binary STL: " + oneLine(input.name);
    std::memcpy(header, title.data(), std::min(title.size(), sizeof header - 1));
    uint32_t count = 0;
    out.raw(header);
    out.raw(count);
    const Status listed = chunks([&](const mesh::Mesh& window, const mesh::Chunk& chunk) -> Status {
        Vertices vertices(window);
        for (const mesh::Triangle& local : chunk.triangles) {
            if (out.failed() || cancelled(input.progress)) return out.finish();
            const mesh::Triangle t = chunk.inMesh(local);
            const Vec3f a = place.position(vertices.position(t.x)), b = place.position(vertices.position(t.y)),
                        c = place.position(vertices.position(t.z));
            if (a == b || b == c || c == a) continue;
            const Vec3d normal = cross((b - a).as<double>(), (c - a).as<double>());
            out.raw(normalized(normal).as<float>(), a, b, c, uint16_t{0});
            ++count;
        }
        return Done{};
    });
    if (!listed.ok()) return listed;
    out.patch(sizeof header, &count, sizeof count);
    return out.finish();
}

static Status writeStl(const ExportInput& input, const Path& temporary, const Path& target) {
    if (input.progress) input.progress->begin("write", input.mesh->chunks.size());
    const ChunkSource whole = [&](const mesh::ChunkVisitor& visit) -> Status {
        for (const mesh::Chunk& chunk : input.mesh->chunks) {
            if (Status status = visit(*input.mesh, chunk); !status.ok()) return status;
            tick(input.progress);
        }
        return Done{};
    };
    return streamStl(input, whole, temporary, target);
}

static constexpr ExportOption stlOptions[] = {upOption, unitOption};

constinit const Exporter stlFormat{
    .extension = ".stl",
    .doc = "STL, binary: positions only",
    .options = stlOptions,
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeStl,
    .stream = streamStl,
};

}  // namespace sgm::exporter
