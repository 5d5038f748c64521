// Wavefront OBJ with its materials in a .mtl beside it (Wavefront, Advanced Visualizer Manual, appendix B). Positions
// stay shared, so the mesh stays closed; normals are cut at hard edges and texture coordinates at chart borders.
#include <fmt/format.h>

#include <set>

#include "modeler/core/atomic_file.h"
#include "modeler/core/random.h"
#include "modeler/export/formats.h"
#include "modeler/export/levels.h"
#include "modeler/export/origins.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"
#include "modeler/export/texture.h"
#include "modeler/image/texture.h"

namespace sgm::exporter {
namespace {

/// Lines of a file that faces count, whatever mesh they belong to.
struct ObjCounts {
    size_t positions = 0, coordinates = 0, normals = 0;
};

/// A mesh's text, a part after the other.
class ObjText {
public:
    /// `before` counts what the file holds already.
    ObjText(OutFile& out, const ExportInput& input, const PatchedMesh& patched, const TextureCharts& texture,
            const ObjCounts& before)
        : before_(before),
          out_(out),
          mesh_(*input.mesh),
          patched_(patched),
          texture_(texture),
          vertices_(mesh_),
          place_(placementOf(input)) {
        if (patched.corners.empty()) return;
        const std::vector<mesh::Triangle> triangles = mesh::gatherTriangles(mesh_);
        smoothing_ = mesh::findSmoothingGroups(mesh_, triangles, patched.corners,
                                               mesh::findEdgeNeighbours(triangles, mesh_.vertexCount()));
    }

    /// All positions; the normals of hard corners, and then those of vertices that need their own.
    void vertices() {
        for (const mesh::Chunk& chunk : mesh_.chunks)
            for (const Vec3f& p : chunk.positions) line("v ", place_.position(p));
        for (const Vec3f& n : patched_.corners.normals) line("vn ", place_.direction(unitNormal(n)));
        normalOf_.assign(mesh_.vertexCount(), 0);
        for (uint32_t v = 0; v < patched_.vertices.size(); ++v)
            if (patched_.normals.empty() || patched_.normals[v] == mesh::noIndex) normalOf_[patched_.vertices[v]] = 1;
        auto next = static_cast<uint32_t>(patched_.corners.normals.size());
        for (uint32_t v = 0; v < normalOf_.size(); ++v) {
            if (normalOf_[v] == 0) continue;
            normalOf_[v] = next++;
            line("vn ", place_.direction(unitNormal(vertices_.normal(v))));
        }
        normalCount_ = next;
    }

    /// What the file holds after `vertices` and all patches.
    ObjCounts counts() const {
        return {before_.positions + mesh_.vertexCount(),
                before_.coordinates + (texture_.empty() ? 0 : patched_.vertices.size()),
                before_.normals + normalCount_};
    }

    /// One patch: its texture coordinates, then its faces as position/texture/normal, counted from 1, with a comment
    /// where their origin changes.
    void patch(const Patch& patch) {
        for (uint32_t v = patch.firstVertex; !texture_.empty() && v < patch.firstVertex + patch.vertexCount; ++v) {
            const auto [s, t] = texture_.at(patched_.charts[v], vertices_.position(patched_.vertices[v]));
            out_.text("vt ");
            out_.number(s);
            out_.text(" ");
            out_.number(t);
            out_.text("\n");
        }
        forOriginRuns(patched_, patch, [&](OriginId origin, uint32_t first, uint32_t count) {
            out_.text("# origin ");
            out_.number(origin);
            out_.text("\n");
            for (uint32_t t = first; t < first + count && !out_.failed(); ++t) face(t);
        });
    }

private:
    void line(std::string_view keyword, Vec3f v) {
        if (out_.failed()) return;
        out_.text(keyword);
        out_.numbers(v, " ");
        out_.text("\n");
    }

    void face(uint32_t t) {
        if (const uint32_t group = smoothing_.empty() ? 1 : smoothing_[patched_.order[t]]; group != smoothed_) {
            out_.text("s ");
            out_.number(smoothed_ = group);
            out_.text("\n");
        }
        out_.text("f");
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t v = patched_.triangles[t][corner];
            const uint32_t own = patched_.normals.empty() ? mesh::noIndex : patched_.normals[v];
            out_.text(" ");
            out_.number(before_.positions + patched_.vertices[v] + 1);
            out_.text("/");
            if (!texture_.empty()) out_.number(before_.coordinates + v + 1);
            out_.text("/");
            out_.number(before_.normals + (own == mesh::noIndex ? normalOf_[patched_.vertices[v]] : own) + 1);
        }
        out_.text("\n");
    }

    const ObjCounts before_;
    OutFile& out_;
    const mesh::Mesh& mesh_;
    const PatchedMesh& patched_;
    const TextureCharts& texture_;
    Vertices vertices_;
    const Placement place_;
    std::vector<uint32_t> smoothing_;  ///< group by triangle in mesh order; empty: 1 for all
    std::vector<uint32_t> normalOf_;   ///< by mesh vertex: number of its line of normals, from 0
    uint32_t smoothed_ = 0;            ///< the group that the last face was put in
    size_t normalCount_ = 0;           ///< lines of normals
};

/// The lines of a texture: its pictures where they are, as many tiles to a metre as `-s` says.
std::string mapsOf(const image::Texture& texture, const Path& folder) {
    std::string text;
    const auto map = [&](std::string_view keyword, const image::ImageFilePtr& file) {
        if (file)
            text += fmt::format("{} -s {} {} 1 {}\n", keyword, 1 / texture.width_m, 1 / texture.height_m,
                                pathFrom(folder, file->path));
    };
    map("map_Kd", texture.color);
    map("map_Pr", texture.roughness);
    map("norm", texture.normals);
    return text;
}

static Status writeMaterials(const ExportInput& input, const std::set<uint32_t>& used,
                             const std::vector<std::string>& names, const Path& target) {
    return replaceFile(target, [&](const Path& temporary) {
        OutFile out(temporary, target, input.progress);
        out.text("# sgm\n");
        for (const uint32_t index : used) {
            const Material& m = input.provenance->materials[index];
            const bool hasMaps = m.texture && option(input, "uv", "scope") != "none";
            // Readers multiply the colour with the picture, which stands in its place.
            const Vec3f color = hasMaps && m.texture->color ? Vec3f{1, 1, 1} : m.color;
            out.text(fmt::format("newmtl {}\nKd {} {} {}\nPr {}\nPm {}\nillum 2\n", names[index], color.x, color.y,
                                 color.z, m.roughness, m.metallic));
            if (hasMaps) out.text(mapsOf(*m.texture, target.parent_path()));
        }
        return out.finish();
    });
}

/// The head of an object: what its shape is, and its name.
std::string objectHead(const ExportInput& input, uint32_t object) {
    if (object == 0) return fmt::format("o {}\n", wordOf(input.name));
    const ObjectNode& node = input.objects->nodes[object];
    const std::string rule = node.rule.empty() ? "" : fmt::format(", rule {}", node.rule);
    const std::string shape = fmt::format("{}{}, {}:{}", node.path, rule, node.file, node.line);
    return fmt::format("# shape {}\no {}\n", oneLine(shape), wordOf(node.name));
}

/// One mesh with what its file needs of it.
struct ObjMesh {
    explicit ObjMesh(const ExportInput& ofInput)
        : input(ofInput),
          texture(chartTexture(option(input, "uv", "scope"), *input.mesh, *input.provenance)),
          patched(
              cutIntoPatches(*input.mesh, *input.provenance, {input.objects, texture.ofTriangle, input.byMaterial})) {}

    /// Writes all of it after what the file holds already; what it holds then.
    ObjCounts write(OutFile& out, const std::vector<std::string>& names, const ObjCounts& before) const {
        ObjText text(out, input, patched, texture, before);
        text.vertices();
        uint32_t object = mesh::noIndex;
        for (const Patch& patch : patched.patches) {
            if (patch.object != object) out.text(objectHead(input, object = patch.object));
            if (input.byMaterial) out.text(fmt::format("usemtl {}\n", names[patch.material]));
            text.patch(patch);
            tick(input.progress);
        }
        return text.counts();
    }

    const ExportInput input;
    const TextureCharts texture;
    const PatchedMesh patched;
};

}  // namespace

/// Its name is one word, since many readers end it at a blank. Where that changes the name, a number keeps it apart
/// from that of a file which has the changed name.
Path materialFile(const Path& target) {
    const std::string name = target.stem().string(), word = wordOf(name);
    const std::string number = word == name ? "" : fmt::format("-{:08x}", static_cast<uint32_t>(hashText(name)));
    return target.parent_path() / (word + number + ".mtl");
}

static Status writeObj(const ExportInput& input, const Path& temporary, const Path& target) {
    const ObjMesh finest(inputOfLevel(input, 0));
    const std::vector<std::string> names = distinctNames(input.provenance->materials, wordOf);
    const Path materials = materialFile(target);

    OutFile out(temporary, target, input.progress);
    out.text("# sgm\n");
    for (const auto& [key, value] : input.extras) out.text(fmt::format("# {}: {}\n", oneLine(key), oneLine(value)));
    for (const OriginId origin : originsOf(*input.mesh, *input.provenance))
        out.text(fmt::format("# origin {}: {}\n", origin, originText(input.provenance->parts[origin])));
    if (input.byMaterial) out.text(fmt::format("mtllib {}\n", materials.filename().string()));
    if (input.progress) input.progress->begin("write", finest.patched.patches.size());
    std::set<uint32_t> used;
    ObjCounts counts;
    const auto writeMesh = [&](const ObjMesh& mesh) {
        for (const Patch& p : mesh.patched.patches) used.insert(p.material);
        // A level is a group, for objects may divide it.
        if (!input.levels.empty()) out.text(fmt::format("g {}\n", wordOf(mesh.input.name)));
        counts = mesh.write(out, names, counts);
    };
    writeMesh(finest);
    for (size_t level = 1; level < levelCount(input); ++level) writeMesh(ObjMesh(inputOfLevel(input, level)));
    if (Status status = out.finish(); !status.ok() || !input.byMaterial) return status;
    // Both files are complete before either is replaced; the .mtl goes first, as the .obj names it.
    return writeMaterials(input, used, names, materials);
}

static constexpr ExportOption objOptions[] = {upOption, unitOption, uvOption};

constinit const Exporter objFormat{
    .extension = ".obj",
    .doc = "Wavefront OBJ, with a .mtl beside it",
    .options = objOptions,
    .takesPositionsOnly = nullptr,
    .write = writeObj,
    .stream = nullptr,
    .beside = materialFile,
    .holdsObjects = true,
    .holdsLevels = true,
};

}  // namespace sgm::exporter
