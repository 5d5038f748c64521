#include "modeler/export/page_data.h"

#include <zlib.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "modeler/export/formats.h"
#include "modeler/export/gltf_primitive.h"
#include "modeler/export/origins.h"
#include "modeler/export/page_textures.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::ordered_json;

/// One node a symbol below the whole, so that a model without objects is shown by the names of its shapes.
ObjectTree treeOfSymbols(const mesh::Mesh& mesh, const Provenance& provenance, const std::string& name) {
    ObjectTree tree;
    tree.nodes.emplace_back().name = name;
    tree.ofOrigin.assign(provenance.parts.size(), 0);
    std::map<std::string, uint32_t> nodeOf;
    for (const OriginId origin : originsOf(mesh, provenance)) {
        const std::string& symbol = provenance.parts[origin].symbol();
        if (symbol.empty()) continue;
        const auto [at, isNew] = nodeOf.try_emplace(symbol, static_cast<uint32_t>(tree.nodes.size()));
        if (isNew) tree.nodes.emplace_back().name = symbol;
        tree.ofOrigin[origin] = at->second;
    }
    return tree;
}

constexpr uint32_t zigzag(int32_t v) { return (static_cast<uint32_t>(v) << 1) ^ static_cast<uint32_t>(v >> 31); }

/// A unit vector on the octahedron unfolded to a square, each coordinate from -127 to 127 (Meyer et al. 2010).
std::array<int, 2> octahedral(Vec3f n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    float u = n.x / sum, v = n.y / sum;
    if (n.z < 0) {
        const float folded = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f);
        v = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f);
        u = folded;
    }
    return {static_cast<int>(std::lround(127 * u)), static_cast<int>(std::lround(127 * v))};
}

class Packer {
public:
    Packer(const ExportInput& input, const ObjectTree& objects)
        : input_(input),
          objects_(objects),
          textures_(*input.mesh, *input.provenance),
          patched_(cutIntoPatches(*input.mesh, *input.provenance, {&objects, textures_.charts(), true})),
          vertices_(*input.mesh),
          bounds_(input.mesh->bounds()),
          grid_(gridOver(static_cast<double>(maxComponent(bounds_.size())))) {}

    /// False when the progress was cancelled.
    bool run() {
        origin_ = originOf(grid_, bounds_);
        if (input_.progress) input_.progress->begin("write", patched_.patches.size());
        partNumber_.assign(input_.provenance->parts.size(), 0);
        Json patches = Json::array();
        for (const Patch& patch : patched_.patches) {
            if (cancelled(input_.progress)) return false;
            orderVertices(patch);
            patches.push_back({{"group", patch.object},
                               {"material", patch.material},
                               {"triangles", patch.triangleCount},
                               {"parts", runsOf(patch)}});
            tick(input_.progress);
        }
        head(std::move(patches));
        return true;
    }

    /// All bytes, the JSON's length first.
    std::vector<uint8_t> bytes() const {
        const std::string text = json_.dump();
        const auto length = static_cast<uint32_t>(text.size());
        std::vector<uint8_t> all(sizeof length + text.size());
        std::memcpy(all.data(), &length, sizeof length);
        std::memcpy(all.data() + sizeof length, text.data(), text.size());
        for (const auto* plane : {&planes_.x, &planes_.y, &planes_.z})
            for (int shift = 0; shift < 16; shift += 8)
                for (const uint16_t v : *plane) all.push_back(static_cast<uint8_t>(v >> shift));
        for (const auto* plane : {&planes_.u, &planes_.v}) all.insert(all.end(), plane->begin(), plane->end());
        all.insert(all.end(), planes_.corners.begin(), planes_.corners.end());
        all.insert(all.end(), planes_.charts.begin(), planes_.charts.end());
        textures_.appendBytes(all);
        return all;
    }

private:
    /// Appends a patch's corners, and its vertices in the order of their first corners.
    void orderVertices(const Patch& patch) {
        constexpr uint32_t unset = 0xffffffffu;
        std::vector<uint32_t> number(patch.vertexCount, unset);
        uint32_t fresh = 0;
        for (uint32_t t = patch.firstTriangle; t < patch.firstTriangle + patch.triangleCount; ++t)
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t vertex = patched_.triangles[t][corner];
                uint32_t& at = number[vertex - patch.firstVertex];
                if (at == unset) {
                    at = fresh++;
                    putNumber(planes_.corners, 0);
                    putVertex(vertex);
                } else {
                    putNumber(planes_.corners, fresh - at);
                }
            }
    }

    static void putNumber(std::vector<uint8_t>& to, uint32_t v) {
        for (; v >= 128; v >>= 7) to.push_back(static_cast<uint8_t>(v | 128));
        to.push_back(static_cast<uint8_t>(v));
    }

    void putVertex(uint32_t vertex) {
        const Vec3<int64_t> steps = stepsFrom(grid_, origin_, vertices_.position(patched_.vertices[vertex]));
        const auto change = [](int64_t to, int64_t& from) {
            // Modulo 2¹⁶, so that the difference fits whatever it is.
            const auto difference = static_cast<int16_t>(static_cast<uint16_t>(to - from));
            from = to;
            return static_cast<uint16_t>(zigzag(difference));
        };
        planes_.x.push_back(change(steps.x, last_.x));
        planes_.y.push_back(change(steps.y, last_.y));
        planes_.z.push_back(change(steps.z, last_.z));
        const auto normal = octahedral(unitNormal(patched_.normal(vertex, vertices_)));
        for (size_t i = 0; i < 2; ++i) {
            const auto difference = static_cast<int8_t>(static_cast<uint8_t>(normal[i] - lastNormal_[i]));
            (i == 0 ? planes_.u : planes_.v).push_back(static_cast<uint8_t>(zigzag(difference)));
            lastNormal_[i] = normal[i];
        }
        if (textures_.empty()) return;
        const auto chart = static_cast<int32_t>(patched_.charts[vertex]);
        putNumber(planes_.charts, zigzag(chart - lastChart_));
        lastChart_ = chart;
    }

    /// Part, triangles, part, triangles …; parts are numbered as they come.
    Json runsOf(const Patch& patch) {
        Json runs = Json::array();
        forOriginRuns(patched_, patch, [&](OriginId origin, uint32_t, uint32_t count) {
            const OriginId known = origin < partNumber_.size() ? origin : 0;
            if (partNumber_[known] == 0) {
                parts_.push_back(known);
                partNumber_[known] = static_cast<uint32_t>(parts_.size());
            }
            runs.push_back(partNumber_[known] - 1);
            runs.push_back(count);
        });
        return runs;
    }

    void head(Json patches) {
        const auto vector = [](auto v) { return Json{v.x, v.y, v.z}; };
        json_ = {{"name", validUtf8(input_.name)},
                 {"vertices", planes_.x.size()},
                 {"triangles", patched_.triangles.size()},
                 {"step", grid_.step},
                 {"origin", vector(origin_)},
                 {"lo", vector(bounds_.lo)},
                 {"hi", vector(bounds_.hi)},
                 {"patches", std::move(patches)}};
        json_["facts"] = json_["parameters"] = Json::object();
        for (const auto& [name, value] : input_.extras) {
            const bool isParameter = name.starts_with("param ");
            json_[isParameter ? "parameters" : "facts"][validUtf8(isParameter ? name.substr(6) : name)] =
                validUtf8(value);
        }
        for (const Material& m : input_.provenance->materials)
            json_["materials"].push_back({{"name", validUtf8(m.name)},
                                          {"color", vector(m.color)},
                                          {"roughness", m.roughness},
                                          {"metallic", m.metallic}});
        if (!textures_.empty()) {
            for (size_t i = 0; i < input_.provenance->materials.size(); ++i)
                json_["materials"][i]["texture"] = textures_.ofMaterial(input_.provenance->materials[i]);
            json_["charts"] = textures_.chartList();
            json_["files"] = textures_.fileList();
        }
        std::vector<uint32_t> count(objects_.nodes.size(), 0);
        for (const OriginId part : parts_) ++count[objects_.nodeOf(part)];
        for (size_t i = 0; i < objects_.nodes.size(); ++i) {
            const ObjectNode& node = objects_.nodes[i];
            json_["groups"].push_back({{"name", validUtf8(i == 0 ? input_.name : node.name)},
                                       {"parent", node.parent},
                                       {"path", validUtf8(node.path)},
                                       {"count", i == 0 ? 0 : count[i]}});
        }
        for (const OriginId origin : parts_) {
            const Part& part = input_.provenance->parts[origin];
            json_["parts"].push_back({{"path", validUtf8(part.path.text())},
                                      {"rule", validUtf8(part.rule())},
                                      {"file", validUtf8(Path(part.file()).filename())},  // pages are for others
                                      {"line", part.line()}});
        }
    }

    const ExportInput& input_;
    const ObjectTree& objects_;
    PageTextures textures_;
    PatchedMesh patched_;
    Vertices vertices_;
    Box3f bounds_;
    QuantizationGrid grid_;
    Vec3<int64_t> origin_, last_{0, 0, 0};
    std::array<int, 2> lastNormal_{0, 0};
    /// What the page reads, number by number.
    struct Planes {
        std::vector<uint16_t> x, y, z;
        std::vector<uint8_t> u, v, corners, charts;
    };
    Planes planes_;
    int32_t lastChart_ = 0;
    std::vector<uint32_t> partNumber_;  ///< by origin: 1 + its place in parts_, 0 where it has none yet
    std::vector<OriginId> parts_;
    Json json_;
};

/// `bytes` compressed, without a header. Errors as packPage's.
Result<std::vector<uint8_t>> deflated(const std::vector<uint8_t>& bytes, const Progress* progress) {
    z_stream stream{};
    constexpr int rawWindow = -15, memory = 9;
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, rawWindow, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        return Error{Error::Kind::Budget, "the page can't be packed: out of memory"};
    constexpr size_t most = size_t{1} << 18;
    std::vector<uint8_t> packed, room(most);
    for (size_t at = 0, ended = 0; ended == 0;) {
        if (cancelled(progress)) return deflateEnd(&stream), cancelledError();
        const size_t n = std::min(most, bytes.size() - at);
        stream.next_in = const_cast<Bytef*>(bytes.data() + at);  // zlib's type; it only reads
        stream.avail_in = static_cast<uInt>(n);
        at += n;
        do {
            stream.next_out = room.data();
            stream.avail_out = static_cast<uInt>(most);
            ended = deflate(&stream, at == bytes.size() ? Z_FINISH : Z_NO_FLUSH) == Z_STREAM_END;
            packed.insert(packed.end(), room.begin(), room.end() - static_cast<std::ptrdiff_t>(stream.avail_out));
        } while (stream.avail_out == 0);
    }
    deflateEnd(&stream);
    return packed;
}

}  // namespace

Result<std::vector<uint8_t>> packPage(const ExportInput& input) {
    const ObjectTree symbols = input.objects ? ObjectTree{} : treeOfSymbols(*input.mesh, *input.provenance, input.name);
    Packer packer(input, input.objects ? *input.objects : symbols);
    if (!packer.run()) return cancelledError();
    return deflated(packer.bytes(), input.progress);
}

}  // namespace sgm::exporter
