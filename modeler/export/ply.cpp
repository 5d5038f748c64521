// PLY, binary little-endian (Turk, "The PLY Polygon File Format", 1994). Vertices stay shared, so the mesh stays
// closed; a vertex on a material border takes the colour of its first triangle.
#include <fmt/format.h>

#include "modeler/export/lists.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

class Ply : public Lists {
public:
    explicit Ply(const ExportInput& input)
        : input_(input), place_(placementOf(input)), bare_(option(input, "attributes", "all") == "none") {
        for (const Material& m : input.provenance->materials) colors_.push_back(srgb(m.color));
    }

    void header(OutFile& out, uint64_t vertices, uint64_t triangles) const override {
        out.text(
            "ply\nformat binary_little_endian 1.0\ncomment sgm, metres and y up unless its options said otherwise\n");
        for (const auto& [key, value] : input_.extras)
            out.text(fmt::format("comment {}: {}\n", oneLine(key), oneLine(value)));
        out.text(fmt::format("element vertex {}\n", vertices));
        out.text("property float x\nproperty float y\nproperty float z\n");
        if (!bare_) {  // texture coordinates are named as Blender looks for them
            for (const char* name : {"nx", "ny", "nz", "s", "t"}) out.text(fmt::format("property float {}\n", name));
            for (const char* name : {"red", "green", "blue"}) out.text(fmt::format("property uchar {}\n", name));
        }
        out.text(fmt::format("element face {}\nproperty list uchar uint vertex_indices\n{}end_header\n", triangles,
                             bare_ ? "" : "property uint origin\n"));
    }

    void vertices(OutFile& out, const mesh::Chunk& chunk) const override {
        const size_t count = chunk.positions.size();
        if (bare_ && place_.isIdentity()) return out.bytes(chunk.positions.data(), count * sizeof(Vec3f));
        if (bare_) {
            out.rows<sizeof(Vec3f)>(count, [&, place = place_, from = chunk.positions.data()](size_t i, char* to) {
                const Vec3f position = place.position(from[i]);
                std::memcpy(to, &position, sizeof position);
            });
            return;
        }
        const std::vector<uint32_t> materials = vertexMaterials(chunk);
        for (size_t i = 0; i < chunk.positions.size() && !out.failed(); ++i) {
            const Vec3f normal = unitNormal(chunk.normals[i]);
            out.raw(place_.position(chunk.positions[i]), place_.direction(normal), boxProjection(chunk.positions[i], facing(normal)), colors_[materials[i]]);
        }
    }

    void triangles(OutFile& out, const mesh::Chunk& chunk) const override {
        constexpr size_t faceBytes = 1 + sizeof(mesh::Triangle);
        const auto face = [from = chunk.triangles.data(), first = chunk.firstVertex, borrowed = chunk.borrowed.vertices.data()](size_t i, char* to) {
            // Two words: the low one holds corners x and y. Ours are all of most triangles'.
            constexpr uint64_t both = 0x100000001u;
            uint64_t xy;
            std::memcpy(&xy, &from[i], sizeof xy);
            uint64_t z = from[i].z;
            if (((xy | z) & both * mesh::borrowedBit) == 0) {
                xy += both * first, z += first;
            } else {
                const auto inMesh = [&](uint64_t corner) -> uint64_t { return corner & mesh::borrowedBit ? borrowed[corner & ~mesh::borrowedBit] : first + corner; };
                xy = inMesh(from[i].x) | inMesh(from[i].y) << 32;
                z = inMesh(from[i].z);
            }
            const uint64_t row[2] = {xy << 8 | 3, xy >> 56 | z << 8};
            std::memcpy(to, row, sizeof row);
        };
        if (bare_) return out.rows<faceBytes>(chunk.triangles.size(), face);
        out.rows<faceBytes + sizeof(OriginId)>(chunk.triangles.size(), [&](size_t i, char* to) {
            face(i, to);
            std::memcpy(to + faceBytes, &chunk.origins[i], sizeof(OriginId));
        });
    }

private:
    /// The material of every vertex: that of the first triangle in the mesh that uses it, which is one of the chunk's
    /// own (a vertex belongs to the lowest block around it).
    std::vector<uint32_t> vertexMaterials(const mesh::Chunk& chunk) const {
        constexpr uint32_t unset = 0xffffffffu;
        std::vector<uint32_t> materials(chunk.positions.size(), unset);
        for (size_t i = 0; i < chunk.triangles.size(); ++i)
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t vertex = chunk.triangles[i][corner];
                if (vertex & mesh::borrowedBit || materials[vertex] != unset) continue;
                materials[vertex] = materialIndex(*input_.provenance, chunk.origins[i]);
            }
        for (uint32_t& material : materials)
            if (material == unset) material = 0;
        return materials;
    }

    const ExportInput& input_;
    const Placement place_;
    const bool bare_;  ///< positions and triangles alone
    std::vector<Rgb8> colors_;
};

}  // namespace

Status writePly(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeLists(Ply(input), input, temporary, target);
}

Status streamPly(const ExportInput& input, const ChunkSource& chunks, const Path& temporary, const Path& target) {
    return streamLists(Ply(input), input, chunks, temporary, target);
}

}  // namespace sgm::exporter
