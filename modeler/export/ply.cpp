// PLY, binary little-endian (Turk, "The PLY Polygon File Format", 1994). Vertices stay shared, so the mesh stays
// closed; a vertex on a material border takes the colour of its first triangle.
#include <fmt/format.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "modeler/export/lists.h"
#include "modeler/export/origins.h"
#include "modeler/export/surface.h"
#include "modeler/image/texture_axes.h"

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
        // All parts: of a mesh that comes in chunks it isn't known yet which of them it shows.
        const auto& parts = input_.provenance->parts;
        for (size_t i = 0; i < parts.size() && !bare_; ++i)
            out.text(fmt::format("comment origin {}: {}\n", i, originText(parts[i])));
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
            const image::TextureAxes along = image::axesAgainst(image::nearestAxis(normal));
            const Vec3f p = chunk.positions[i];
            const std::array<float, 2> uv{dot(p, along.u.as<float>()), dot(p, along.v.as<float>())};
            out.raw(place_.position(p), place_.direction(normal), uv, colors_[materials[i]]);
        }
    }

    void triangles(OutFile& out, const mesh::Chunk& chunk) const override {
        constexpr size_t faceBytes = 1 + sizeof(mesh::Triangle);
        const auto face = [&chunk, from = chunk.triangles.data(), first = chunk.firstVertex](size_t i, char* to) {
#if defined(__SSE2__)
            // A row in one register; its last three bytes are the next one's. Ours are all corners of most triangles.
            const auto number = [](uint32_t n) { return _mm_cvtsi32_si128(static_cast<int>(n)); };
            const auto corners = [&](const mesh::Triangle& t) {
                return _mm_unpacklo_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&t)), number(t.z));
            };
            __m128i row = corners(from[i]);
            if (_mm_movemask_ps(_mm_castsi128_ps(row)) == 0) [[likely]]
                row = _mm_add_epi32(row, _mm_shuffle_epi32(number(first), 0));
            else
                row = corners(chunk.inMesh(from[i]));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_or_si128(_mm_slli_si128(row, 1), number(3)));
#else
            const mesh::Triangle t = chunk.inMesh(from[i]);
            *to = 3;
            std::memcpy(to + 1, &t, sizeof t);
#endif
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
                if (vertex & mesh::ghostBit || materials[vertex] != unset) continue;
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

static Status writePly(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeLists(Ply(input), input, temporary, target);
}

static Status streamPly(const ExportInput& input, const ChunkSource& chunks, const Path& temporary,
                        const Path& target) {
    return streamLists(Ply(input), input, chunks, temporary, target);
}

static constexpr ExportOption plyOptions[] = {
    upOption,
    unitOption,
    {"attributes", "all", "all|none",
     "what vertices and faces carry beside the shape; none: 19 bytes a triangle, not 34"}};

static bool withoutAttributes(const ExportOptions& options) {
    const auto asked = options.find("attributes");
    return asked != options.end() && asked->second == "none";
}

constinit const Exporter plyFormat{
    .extension = ".ply",
    .doc = "PLY, binary: normals, texture coordinates s t, colours, an origin a face",
    .options = plyOptions,
    .takesPositionsOnly = withoutAttributes,
    .write = writePly,
    .stream = streamPly,
};

}  // namespace sgm::exporter
