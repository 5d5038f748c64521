// PLY, binary little-endian (Turk, "The PLY Polygon File Format", 1994). Vertices stay shared, so the mesh stays
// closed; a vertex on a material border takes the colour of its first triangle.
#include <fmt/format.h>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

bool bare(const ExportInput& input) { return option(input, "attributes", "all") == "none"; }

void writeHeader(OutFile& out, const ExportInput& input) {
    out.text("ply\nformat binary_little_endian 1.0\ncomment sgm, metres and y up unless its options said otherwise\n");
    for (const auto& [key, value] : input.extras)
        out.text(fmt::format("comment {}: {}\n", oneLine(key), oneLine(value)));
    out.text(fmt::format("element vertex {}\n", input.mesh->vertexCount()));
    out.text("property float x\nproperty float y\nproperty float z\n");
    if (!bare(input)) {  // texture coordinates are named as Blender looks for them
        for (const char* name : {"nx", "ny", "nz", "s", "t"}) out.text(fmt::format("property float {}\n", name));
        for (const char* name : {"red", "green", "blue"}) out.text(fmt::format("property uchar {}\n", name));
    }
    out.text(fmt::format("element face {}\nproperty list uchar uint vertex_indices\n{}end_header\n",
                         input.mesh->triangleCount(), bare(input) ? "" : "property uint origin\n"));
}

/// The material of every vertex: that of the first triangle that uses it.
std::vector<uint32_t> vertexMaterials(const mesh::Mesh& mesh, const Provenance& provenance) {
    constexpr uint32_t unset = 0xffffffffu;
    std::vector<uint32_t> materials(mesh.vertexCount(), unset);
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (size_t i = 0; i < chunk.triangles.size(); ++i)
            for (int corner = 0; corner < 3; ++corner) {
                uint32_t& material = materials[chunk.inMesh(chunk.triangles[i][corner])];
                if (material == unset) material = materialIndex(provenance, chunk.origins[i]);
            }
    for (uint32_t& material : materials)
        if (material == unset) material = 0;
    return materials;
}

}  // namespace

Status writePly(const ExportInput& input, const Path& temporary, const Path& target) {
    const mesh::Mesh& mesh = *input.mesh;
    const Placement place = placementOf(input);
    const bool all = !bare(input);
    const std::vector<uint32_t> materials =
        all ? vertexMaterials(mesh, *input.provenance) : std::vector<uint32_t>{};
    std::vector<Rgb8> colors;
    for (const Material& m : input.provenance->materials) colors.push_back(srgb(m.color));

    OutFile out(temporary, target, input.progress);
    writeHeader(out, input);
    if (input.progress) input.progress->begin("write", 2 * mesh.chunks.size());
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (size_t i = 0; i < chunk.positions.size() && !out.failed(); ++i) {
            out.raw(place.position(chunk.positions[i]));
            if (!all) continue;
            const Vec3f normal = unitNormal(chunk.normals[i]);
            out.raw(place.direction(normal));
            out.raw(boxProjection(chunk.positions[i], facing(normal)));
            out.raw(colors[materials[chunk.firstVertex + i]]);
        }
        tick(input.progress);
    }
    for (const mesh::Chunk& chunk : mesh.chunks) {
        for (size_t i = 0; i < chunk.triangles.size() && !out.failed(); ++i) {
            out.raw(uint8_t{3});
            out.raw(chunk.inMesh(chunk.triangles[i]));
            if (all) out.raw(chunk.origins[i]);
        }
        tick(input.progress);
    }
    return out.finish();
}

}  // namespace sgm::exporter
