// STL, binary (3D Systems, StereoLithography Interface Specification, 1989): triangles with positions only.
#include <algorithm>
#include <cstring>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

/// Calls visit(a, b, c) with the placed corners of every triangle, in order. Those with two equal corners are left out:
/// the format matches corners by position, and without such a triangle its two neighbours still meet in one edge.
/// False when cancelled.
template <class Visit>
bool forEachTriangle(const ExportInput& input, const Placement& place, Visit visit) {
    Vertices vertices(*input.mesh);
    for (const mesh::Chunk& chunk : input.mesh->chunks) {
        for (const mesh::Triangle& local : chunk.triangles) {
            if (cancelled(input.progress)) return false;
            const mesh::Triangle t = chunk.inMesh(local);
            const Vec3f a = place.position(vertices.position(t.x)), b = place.position(vertices.position(t.y)),
                        c = place.position(vertices.position(t.z));
            if (a != b && b != c && c != a) visit(a, b, c);
        }
        tick(input.progress);
    }
    return true;
}

}  // namespace

Status writeStl(const ExportInput& input, const Path& temporary, const Path& target) {
    const Placement place = placementOf(input);
    if (input.progress) input.progress->begin("write", 2 * input.mesh->chunks.size());
    uint32_t count = 0;
    if (!forEachTriangle(input, place, [&](Vec3f, Vec3f, Vec3f) { ++count; })) return cancelledError();

    OutFile out(temporary, target, input.progress);
    char header[80] = {};  // must not begin with "solid"
    const std::string title = "sgm binary STL: " + oneLine(input.name);
    std::memcpy(header, title.data(), std::min(title.size(), sizeof header - 1));
    out.raw(header);
    out.raw(count);
    const bool complete = forEachTriangle(input, place, [&](Vec3f a, Vec3f b, Vec3f c) {
        const Vec3d normal = cross((b - a).as<double>(), (c - a).as<double>());
        out.raw(normalized(normal).as<float>());
        out.raw(a);
        out.raw(b);
        out.raw(c);
        out.raw(uint16_t{0});
    });
    if (!complete) return cancelledError();
    return out.finish();
}

}  // namespace sgm::exporter
