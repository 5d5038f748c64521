#include "tests/export/unpack.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <cstring>

#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

class Reader {
public:
    explicit Reader(const std::string& file) {
        uint32_t length = 0;
        std::memcpy(&length, file.data() + 12, 4);
        json = Json::parse(file.substr(20, length));
        binary_.assign(file.begin() + 20 + length + 8, file.end());
        for (const Json& view : json["bufferViews"]) views_.push_back(bytesOf(view));
    }

    void mesh(const Json& mesh, UnpackedMesh& out) const {
        for (const Json& primitive : mesh["primitives"])
            if (primitive.contains("extensions"))
                addDraco(primitive, out);
            else
                addPrimitive(primitive, out);
    }

    Json json;

private:
    Bytes bytesOf(const Json& view) const {
        if (!view.contains("extensions")) {
            const auto begin = binary_.begin() + view.value("byteOffset", 0);
            return {begin, begin + view["byteLength"].get<int>()};
        }
        const Json& packed = view["extensions"]["EXT_meshopt_compression"];
        const unsigned char* from = binary_.data() + packed["byteOffset"].get<size_t>();
        const auto length = packed["byteLength"].get<size_t>(), count = packed["count"].get<size_t>(),
                   stride = packed["byteStride"].get<size_t>();
        Bytes out(count * stride);
        const std::string mode = packed["mode"], filter = packed.value("filter", "NONE");
        int failed = 0;
        if (mode == "ATTRIBUTES") failed = meshopt_decodeVertexBuffer(out.data(), count, stride, from, length);
        if (mode == "TRIANGLES") failed = meshopt_decodeIndexBuffer(out.data(), count, stride, from, length);
        if (mode == "INDICES") failed = meshopt_decodeIndexSequence(out.data(), count, stride, from, length);
        if (failed != 0) throw std::runtime_error("meshoptimizer refuses a view of mode " + mode);
        if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
        if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
        return out;
    }

    /// An accessor's numbers, `components` an element.
    std::vector<double> numbers(const Json& index, size_t components) const {
        const Json& accessor = json["accessors"][index.get<size_t>()];
        const auto at = accessor["bufferView"].get<size_t>();
        const int type = accessor["componentType"];
        const size_t bytes = type == 5120 ? 1 : type == 5123 ? 2 : 4;
        const size_t stride = json["bufferViews"][at].value("byteStride", components * bytes);
        std::vector<double> out;
        for (size_t i = 0; i < accessor["count"]; ++i)
            for (size_t c = 0; c < components; ++c) {
                const unsigned char* from =
                    views_[at].data() + accessor.value("byteOffset", size_t{0}) + i * stride + c * bytes;
                out.push_back(type == 5120   ? std::max(load<int8_t>(from) / 127.0, -1.0)
                              : type == 5123 ? load<uint16_t>(from)
                              : type == 5125 ? load<uint32_t>(from)
                                             : static_cast<double>(load<float>(from)));
            }
        return out;
    }

    template <class T>
    static T load(const unsigned char* from) {
        T value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }

    std::string materialOf(const Json& primitive) const {
        return primitive.contains("material") ? json["materials"][primitive["material"].get<size_t>()]["name"]
                                              : Json("");
    }

    void addPrimitive(const Json& primitive, UnpackedMesh& mesh) const {
        ReadBack& out = mesh.data;
        const Json& attributes = primitive["attributes"];
        const auto base = static_cast<uint32_t>(out.positions.size());
        const std::vector<double> p = numbers(attributes["POSITION"], 3), corners = numbers(primitive["indices"], 1);
        for (size_t i = 0; i < p.size(); i += 3) out.positions.push_back(Vec3d{p[i], p[i + 1], p[i + 2]}.as<float>());
        if (attributes.contains("NORMAL")) {
            const std::vector<double> n = numbers(attributes["NORMAL"], 3);
            for (size_t i = 0; i < n.size(); i += 3)
                out.normals.push_back(normalized(Vec3d{n[i], n[i + 1], n[i + 2]}).as<float>());
        }
        if (attributes.contains("COLOR_0")) {
            const std::vector<double> c = numbers(attributes["COLOR_0"], 4);
            for (size_t i = 0; i < c.size(); i += 4)
                mesh.colors.push_back({c[i] / 65535, c[i + 1] / 65535, c[i + 2] / 65535, c[i + 3] / 65535});
        }
        if (attributes.contains("TEXCOORD_0")) {
            const std::vector<double> uv = numbers(attributes["TEXCOORD_0"], 2);
            for (size_t i = 0; i < uv.size(); i += 2)
                out.uvs.push_back({static_cast<float>(uv[i]), static_cast<float>(uv[i + 1])});
        }
        for (size_t i = 0; i < corners.size(); i += 3) {
            const Vec3d t{corners[i], corners[i + 1], corners[i + 2]};
            out.triangles.push_back(t.as<uint32_t>() + mesh::Triangle{base, base, base});
            out.materials.push_back(materialOf(primitive));
        }
    }

    void addDraco(const Json& primitive, UnpackedMesh& unpacked) const {
        ReadBack& out = unpacked.data;
        const Json& packed = primitive["extensions"]["KHR_draco_mesh_compression"];
        const Bytes& bytes = views_[packed["bufferView"].get<size_t>()];
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
        const draco::Mesh& mesh = *decoded.value();
        const auto base = static_cast<uint32_t>(out.positions.size());
        const auto checkCount = [&](const Json& accessor, size_t count) {
            if (json["accessors"][accessor.get<size_t>()]["count"] != count)
                throw std::runtime_error("a count of an accessor is wrong");
        };
        for (const auto& [name, id] : packed["attributes"].items()) {
            const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
            checkCount(primitive["attributes"][name], mesh.num_points());
            for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
                if (name == "COLOR_0") {
                    std::array<uint16_t, 4> c{};
                    attribute->GetMappedValue(i, c.data());
                    unpacked.colors.push_back({c[0] / 65535.0, c[1] / 65535.0, c[2] / 65535.0, c[3] / 65535.0});
                    continue;
                }
                float v[3] = {};
                attribute->GetMappedValue(i, v);
                if (name == "POSITION") out.positions.push_back({v[0], v[1], v[2]});
                if (name == "NORMAL") out.normals.push_back(normalized(Vec3f{v[0], v[1], v[2]}));
                if (name == "TEXCOORD_0") out.uvs.push_back({v[0], v[1]});
            }
        }
        checkCount(primitive["indices"], 3 * mesh.num_faces());
        for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
            const auto& t = mesh.face(f);
            out.triangles.push_back({base + t[0].value(), base + t[1].value(), base + t[2].value()});
            out.materials.push_back(materialOf(primitive));
        }
    }

    Bytes binary_;
    std::vector<Bytes> views_;  ///< by view, unpacked
};

/// Where a node's own points are in the world: p → rotation · (scale ⊙ p) + move.
struct Place {
    Mat3 rotation;
    Vec3d scale{1, 1, 1}, move;

    Vec3d operator()(Vec3d p) const { return rotation * (scale * p) + move; }
};

Vec3d vectorOf(const Json& node, const char* key, double fallback) {
    if (!node.contains(key)) return {fallback, fallback, fallback};
    return {node[key][0], node[key][1], node[key][2]};
}

/// A node's place in that of its parent, which isn't scaled where the node is turned.
Place placeOf(const Json& node, const Place& parent) {
    Place at{parent.rotation, parent.scale * vectorOf(node, "scale", 1), parent(vectorOf(node, "translation", 0))};
    if (node.contains("rotation")) {
        const double x = node["rotation"][0], y = node["rotation"][1], z = node["rotation"][2], w = node["rotation"][3];
        at.rotation = at.rotation * Mat3{{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
                                         {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
                                         {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
    }
    return at;
}

}  // namespace

Unpacked unpack(const std::filesystem::path& path) {
    const std::string file = contentOf(path);
    if (file.size() < 20) return {};
    const Reader reader(file);
    Unpacked out{reader.json, {}};
    const Json& nodes = reader.json["nodes"];
    std::vector<Place> places(nodes.size());
    std::vector<size_t> left{reader.json["scenes"][0]["nodes"].get<std::vector<size_t>>()};
    for (const size_t i : left) places[i] = placeOf(nodes[i], {});
    while (!left.empty()) {
        const size_t i = left.back();
        left.pop_back();
        for (const size_t child : nodes[i].value("children", std::vector<size_t>()))
            places[child] = placeOf(nodes[child], places[i]), left.push_back(child);
    }
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].contains("mesh")) continue;
        const Json& mesh = reader.json["meshes"][nodes[i]["mesh"].get<size_t>()];
        UnpackedMesh one{nodes[i].value("name", ""), mesh.value("name", ""), places[i].scale.x, {}, {}};
        reader.mesh(mesh, one);
        for (Vec3f& p : one.data.positions) p = places[i](p.as<double>()).as<float>();
        out.meshes.push_back(std::move(one));
    }
    return out;
}

}  // namespace sgm::exporter
