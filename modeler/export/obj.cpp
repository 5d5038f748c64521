// Wavefront OBJ with its materials in a .mtl beside it (Wavefront, Advanced Visualizer Manual, appendix B). Positions
// and normals stay shared, so the mesh stays closed; only texture coordinates are cut at chart borders.
#include <fmt/format.h>

#include "modeler/core/atomic_file.h"
#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

/// The .mtl lies beside the .obj; its name is one word, since many readers end it at a blank.
Path materialFile(const Path& target) { return target.parent_path() / wordOf(target.stem().string() + ".mtl"); }

void writeVertices(OutFile& out, const mesh::Mesh& mesh, const Placement& place) {
    const auto line = [&](std::string_view keyword, Vec3f v) {
        if (out.failed()) return;
        out.text(keyword);
        out.numbers(v, " ");
        out.text("\n");
    };
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const Vec3f& p : chunk.positions) line("v ", place.position(p));
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const Vec3f& n : chunk.normals) line("vn ", place.direction(unitNormal(n)));
}

/// One patch: its texture coordinates, then its faces as position/texture/normal, counted from 1.
void writePatch(OutFile& out, const PatchedMesh& patched, const Patch& patch, Vertices& vertices, bool textured) {
    for (uint32_t v = patch.firstVertex; textured && v < patch.firstVertex + patch.vertexCount; ++v) {
        const auto [s, t] = boxProjection(vertices.position(patched.vertices[v]), patch.facing);
        out.text("vt ");
        out.number(s);
        out.text(" ");
        out.number(t);
        out.text("\n");
    }
    for (uint32_t t = patch.firstTriangle; t < patch.firstTriangle + patch.triangleCount && !out.failed(); ++t) {
        out.text("f");
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t v = patched.triangles[t][corner];
            out.text(" ");
            out.number(patched.vertices[v] + 1);
            out.text("/");
            if (textured) out.number(v + 1);
            out.text("/");
            out.number(patched.vertices[v] + 1);
        }
        out.text("\n");
    }
}

Status writeMaterials(const ExportInput& input, const PatchedMesh& patched, const std::vector<std::string>& names,
                      const Path& target) {
    return replaceFile(target, [&](const Path& temporary) {
        OutFile out(temporary, target, input.progress);
        out.text("# sgm\n");
        for (size_t i = 0; i < patched.patches.size(); ++i) {
            const uint32_t index = patched.patches[i].material;
            if (i > 0 && patched.patches[i - 1].material == index) continue;
            const Material& m = input.provenance->materials[index];
            out.text(fmt::format("newmtl {}\nKd {} {} {}\nPr {}\nPm {}\nillum 2\n", names[index], m.color.x, m.color.y,
                                 m.color.z, m.roughness, m.metallic));
        }
        return out.finish();
    });
}

}  // namespace

Status writeObj(const ExportInput& input, const Path& temporary, const Path& target) {
    const bool textured = option(input, "uv", "box") == "box";
    const PatchedMesh patched = cutIntoPatches(*input.mesh, *input.provenance, textured);
    const std::vector<std::string> names = distinctNames(input.provenance->materials, wordOf);
    const Path materials = materialFile(target);

    OutFile out(temporary, target, input.progress);
    out.text("# sgm\n");
    for (const auto& [key, value] : input.extras) out.text(fmt::format("# {}: {}\n", oneLine(key), oneLine(value)));
    out.text(fmt::format("mtllib {}\no {}\n", materials.filename().string(), wordOf(input.name)));
    writeVertices(out, *input.mesh, placementOf(input));
    if (input.progress) input.progress->begin("write", patched.patches.size());
    Vertices vertices(*input.mesh);
    for (size_t i = 0; i < patched.patches.size(); ++i) {
        const Patch& patch = patched.patches[i];
        if (i == 0 || patched.patches[i - 1].material != patch.material)
            out.text(fmt::format("usemtl {}\n", names[patch.material]));
        writePatch(out, patched, patch, vertices, textured);
        tick(input.progress);
    }
    if (Status status = out.finish(); !status.ok()) return status;
    // Both files are complete before either is replaced; the .mtl goes first, as the .obj names it.
    return writeMaterials(input, patched, names, materials);
}

}  // namespace sgm::exporter
