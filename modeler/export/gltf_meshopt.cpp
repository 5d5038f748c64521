// EXT_meshopt_compression over KHR_mesh_quantization, by meshoptimizer: vertices as bytes' differences, triangles in an
// order that repeats corners soon.
#include "modeler/export/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "modeler/export/gltf_primitive.h"

namespace sgm::exporter {
namespace {

constexpr const char* extension = "EXT_meshopt_compression";
constexpr int normalBits = 8;

/// The elements of one attribute of all surfaces, one after the other.
struct Stream {
    size_t stride;
    const char* filter;
    int componentType, type;
    bool normalized;
    std::vector<unsigned char> bytes = {};

    size_t count() const { return bytes.size() / stride; }
    /// Appends a value, padded to the stride.
    template <class T>
    void add(const T& value) {
        add(&value, sizeof value);
    }
    void add(const void* value, size_t size) {
        bytes.resize(bytes.size() + stride);
        std::memcpy(bytes.data() + bytes.size() - stride, value, size);
    }
};

/// `v` as the filter EXPONENTIAL has it: the exponent of the grid's step above 24 bits of steps.
uint32_t exponential(const QuantizationGrid& grid, float v) {
    const auto steps = static_cast<uint32_t>(grid.nearest(static_cast<double>(v)));
    return (steps & 0xffffffu) | static_cast<uint32_t>(std::ilogb(grid.step)) << 24;
}

/// The finest grid on which no coordinate is more than 65,534 steps from 0.
QuantizationGrid gridOf(const std::vector<std::array<float, 2>>& coordinates) {
    float most = 0;
    for (const auto& [u, v] : coordinates) most = std::max({most, std::abs(u), std::abs(v)});
    return gridOver(static_cast<double>(most));
}

class MeshoptPacker {
public:
    MeshoptPacker(tinygltf::Model model, Progress* progress) : progress_(progress) { out_.model = std::move(model); }

    Result<MeshoptModel> run() {
        // The format's decoders want this version; it is the library's state, not an argument.
        static std::once_flag version;
        std::call_once(version, [] { meshopt_encodeIndexVersion(1); });
        tinygltf::Model& model = out_.model;
        if (Status done = read(); !done.ok()) return done.error();
        TakenData taken(model);
        for (size_t i = 0; i < meshes_.size(); ++i)
            for (size_t k = 0; k < model.meshes[i].primitives.size(); ++k) {
                if (cancelled(progress_)) return cancelledError();
                tinygltf::Primitive& primitive = model.meshes[i].primitives[k];
                if (meshes_[i])
                    pack(primitive, meshes_[i]->primitives[k], originOf(grid_, meshes_[i]->bounds));
                else
                    taken.keep(primitive, [this](const auto& view, auto bytes) { return addLossless(view, bytes); });
            }
        for (auto& [name, stream] : streams_) {
            if (cancelled(progress_)) return cancelledError();
            addVertices(stream.bytes, {0, 0, stream.stride, stream.count(), "ATTRIBUTES", stream.filter},
                        viewOf_.at(name));
        }
        placeNodes();
        for (const char* used : {extension, "KHR_mesh_quantization"}) {
            model.extensionsUsed.emplace_back(used);
            model.extensionsRequired.emplace_back(used);
        }
        return std::move(out_);
    }

private:
    Status read() {
        float extent = 0;
        for (const tinygltf::Mesh& mesh : out_.model.meshes) {
            meshes_.emplace_back();
            if (!isSurface(mesh)) continue;
            auto data = readMesh(out_.model, mesh);
            if (!data.ok()) return data.error();
            extent = std::max(extent, maxComponent(data->bounds.size()));
            meshes_.back() = std::move(*data);
        }
        grid_ = gridOver(static_cast<double>(extent));
        return Done{};
    }

    /// Vertices in the order of their first corners, which shrinks the file. Triangles keep theirs, as extras may count
    /// them.
    void pack(tinygltf::Primitive& primitive, const PrimitiveData& data, Vec3<int64_t> origin) {
        const size_t corners = data.indices.size(), vertices = data.positions.size();
        std::vector<uint32_t> indices = data.indices, newIndex(vertices);
        const size_t used = meshopt_optimizeVertexFetchRemap(newIndex.data(), indices.data(), corners, vertices);
        meshopt_remapIndexBuffer(indices.data(), indices.data(), corners, newIndex.data());
        std::vector<uint32_t> order(used);
        for (uint32_t v = 0; v < vertices; ++v)
            if (newIndex[v] < used) order[newIndex[v]] = v;

        addPositions(primitive, data.positions, order, origin);
        addNormals(primitive, data.normals, order);
        for (const auto& [name, uv] : data.textureCoordinates) addTextureCoordinates(primitive, name, uv, order);
        for (const auto& [name, other] : data.others) addOther(primitive, name, other, order);
        addTriangles(primitive, indices, used);
    }

    void addPositions(tinygltf::Primitive& primitive, const std::vector<Vec3f>& positions,
                      const std::vector<uint32_t>& order, Vec3<int64_t> origin) {
        Stream& stream =
            streamOf("POSITION", {8, "NONE", TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC3, false});
        Vec3<int64_t> lo{65535, 65535, 65535}, hi{0, 0, 0};
        tinygltf::Accessor& accessor = addTo(primitive, "POSITION", stream, order.size());
        for (const uint32_t v : order) {
            const Vec3<int64_t> steps = stepsFrom(grid_, origin, positions[v]);
            lo = min(lo, steps), hi = max(hi, steps);
            stream.add(steps.as<uint16_t>());
        }
        const Vec3d least = lo.as<double>(), most = hi.as<double>();
        accessor.minValues = {least.x, least.y, least.z};
        accessor.maxValues = {most.x, most.y, most.z};
    }

    void addNormals(tinygltf::Primitive& primitive, const std::vector<Vec3f>& normals,
                    const std::vector<uint32_t>& order) {
        Stream& stream = streamOf("NORMAL", {4, "OCTAHEDRAL", TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_TYPE_VEC3, true});
        addTo(primitive, "NORMAL", stream, order.size());
        for (const uint32_t v : order) {
            const float unit[4] = {normals[v].x, normals[v].y, normals[v].z, 0};
            uint32_t encoded = 0;
            meshopt_encodeFilterOct(&encoded, 1, sizeof encoded, normalBits, unit);
            stream.add(encoded);
        }
    }

    void addTextureCoordinates(tinygltf::Primitive& primitive, const std::string& name,
                               const std::vector<std::array<float, 2>>& uv, const std::vector<uint32_t>& order) {
        Stream& stream = streamOf(name, {8, "EXPONENTIAL", TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, false});
        addTo(primitive, name, stream, order.size());
        const QuantizationGrid grid = gridOf(uv);
        for (const uint32_t v : order) stream.add(std::array{exponential(grid, uv[v][0]), exponential(grid, uv[v][1])});
    }

    void addOther(tinygltf::Primitive& primitive, const std::string& name, const RawAttribute& other,
                  const std::vector<uint32_t>& order) {
        const std::string key = fmt::format("{} {} {}", name, other.componentType, other.type);
        Stream& stream = streamOf(
            key, {(other.elementBytes + 3) / 4 * 4, "NONE", other.componentType, other.type, other.normalized});
        addTo(primitive, name, stream, order.size(), key);
        for (const uint32_t v : order) stream.add(other.bytes.data() + v * other.elementBytes, other.elementBytes);
    }

    void addTriangles(tinygltf::Primitive& primitive, const std::vector<uint32_t>& indices, size_t vertices) {
        const bool small = vertices < 65535;  // that number itself would end a strip
        std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
        bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
        tinygltf::Accessor accessor;
        accessor.bufferView = addView();
        accessor.count = indices.size();
        accessor.type = TINYGLTF_TYPE_SCALAR;
        accessor.componentType = small ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        primitive.indices = addAccessor(out_.model, accessor);
        store(bytes, {0, 0, small ? size_t{2} : size_t{4}, indices.size(), "TRIANGLES"}, accessor.bufferView,
              TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }

    /// Adds a view of the same bytes, packed without loss.
    int addLossless(const tinygltf::BufferView& old, std::span<const unsigned char> bytes) {
        const int view = addView();
        if (old.byteStride > 0) {
            addVertices(bytes, {0, 0, old.byteStride, bytes.size() / old.byteStride, "ATTRIBUTES"}, view);
            return view;
        }
        std::vector<uint32_t> indices(bytes.size() / 4);
        std::memcpy(indices.data(), bytes.data(), 4 * indices.size());
        std::vector<unsigned char> packed(meshopt_encodeIndexSequenceBound(indices.size(), 0xffffffffu));
        packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size()));
        store(packed, {0, 0, 4, indices.size(), "INDICES"}, view, old.target);
        return view;
    }

    void addVertices(std::span<const unsigned char> bytes, const MeshoptView& facts, int view) {
        std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(facts.count, facts.stride));
        packed.resize(
            meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), facts.count, facts.stride));
        store(packed, facts, view, TINYGLTF_TARGET_ARRAY_BUFFER);
        out_.model.bufferViews[static_cast<size_t>(view)].byteStride = facts.stride;
    }

    int addView() {
        out_.model.bufferViews.emplace_back();
        out_.views.emplace_back();
        return static_cast<int>(out_.views.size()) - 1;
    }

    /// Appends packed bytes as what a view holds. Unpacked, views lie one after another in buffer 1.
    void store(std::span<const unsigned char> packed, MeshoptView facts, int index, int target) {
        auto& data = out_.model.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);
        facts.offset = data.size();
        facts.length = packed.size();
        data.insert(data.end(), packed.begin(), packed.end());
        out_.unpackedBytes = (out_.unpackedBytes + 3) / 4 * 4;
        tinygltf::BufferView& view = out_.model.bufferViews[static_cast<size_t>(index)];
        view.buffer = 1;
        view.byteOffset = out_.unpackedBytes;
        view.byteLength = facts.count * facts.stride;
        view.target = target;
        out_.unpackedBytes += view.byteLength;
        out_.views[static_cast<size_t>(index)] = facts;
    }

    Stream& streamOf(const std::string& name, const Stream& fresh) {
        const auto [at, added] = streams_.try_emplace(name, fresh);
        if (added) viewOf_[name] = addView();
        return at->second;
    }

    /// An accessor of the next `count` elements of a stream; valid until the next one is added.
    tinygltf::Accessor& addTo(tinygltf::Primitive& primitive, const std::string& name, const Stream& stream,
                              size_t count, const std::string& key = "") {
        tinygltf::Accessor accessor;
        accessor.bufferView = viewOf_.at(key.empty() ? name : key);
        accessor.byteOffset = stream.bytes.size();
        accessor.componentType = stream.componentType;
        accessor.type = stream.type;
        accessor.normalized = stream.normalized;
        accessor.count = count;
        primitive.attributes[name] = addAccessor(out_.model, accessor);
        return out_.model.accessors.back();
    }

    /// Lets every node with a packed mesh turn the grid's numbers into metres. The scale is a power of two and the
    /// translation a multiple of it, so that this rounds nothing.
    void placeNodes() {
        tinygltf::Model& model = out_.model;
        for (size_t i = 0, count = model.nodes.size(); i < count; ++i) {
            const int mesh = model.nodes[i].mesh;
            if (mesh < 0 || !meshes_[static_cast<size_t>(mesh)]) continue;
            if (!model.nodes[i].children.empty() || !model.nodes[i].matrix.empty() ||
                !model.nodes[i].rotation.empty()) {
                tinygltf::Node own;
                own.name = model.meshes[static_cast<size_t>(mesh)].name;
                own.mesh = mesh;
                model.nodes[i].mesh = -1;
                model.nodes[i].children.insert(model.nodes[i].children.begin(), static_cast<int>(model.nodes.size()));
                model.nodes.push_back(own);
                place(model.nodes.back());
            } else {
                place(model.nodes[i]);
            }
        }
    }

    void place(tinygltf::Node& node) const {
        const MeshData& mesh = *meshes_[static_cast<size_t>(node.mesh)];
        const Vec3d origin = originOf(grid_, mesh.bounds).as<double>() * grid_.step;
        if (node.scale.empty()) node.scale = {1, 1, 1};
        if (node.translation.empty()) node.translation = {0, 0, 0};
        for (size_t axis = 0; axis < 3; ++axis) {
            node.translation[axis] += node.scale[axis] * origin[static_cast<int>(axis)];
            node.scale[axis] *= grid_.step;
        }
    }

    Progress* progress_;
    MeshoptModel out_;
    QuantizationGrid grid_;
    std::vector<std::optional<MeshData>> meshes_;  ///< of surfaces
    std::map<std::string, Stream> streams_;        ///< by attribute, and type where it is kept
    std::map<std::string, int> viewOf_;            ///< of each stream
};

/// The packed model as JSON, its buffer as a data URI where that is wanted.
nlohmann::json jsonOf(MeshoptModel& packed, bool withData) {
    const size_t bytes = packed.model.buffers[0].data.size();
    std::vector<tinygltf::Buffer> buffers;
    if (!withData) buffers = std::exchange(packed.model.buffers, {});
    std::stringstream text;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&packed.model, text, false, false);
    if (!withData) packed.model.buffers = std::move(buffers);
    nlohmann::json root = nlohmann::json::parse(text);
    if (!withData) root["buffers"] = nlohmann::json::array({{{"byteLength", bytes}}});
    root["buffers"].push_back(
        {{"byteLength", packed.unpackedBytes}, {"extensions", {{extension, {{"fallback", true}}}}}});
    for (size_t i = 0; i < packed.views.size(); ++i) {
        const MeshoptView& view = packed.views[i];
        nlohmann::json facts{{"buffer", 0},
                             {"byteOffset", view.offset},
                             {"byteLength", view.length},
                             {"byteStride", view.stride},
                             {"count", view.count},
                             {"mode", view.mode}};
        if (std::string_view(view.filter) != "NONE") facts["filter"] = view.filter;
        root["bufferViews"][i]["extensions"][extension] = std::move(facts);
    }
    return root;
}

}  // namespace

Result<MeshoptModel> packByMeshopt(tinygltf::Model model, Progress* progress) {
    return MeshoptPacker(std::move(model), progress).run();
}

void writeMeshopt(MeshoptModel& packed, std::ostream& out, bool binary) {
    if (!binary) {
        out << jsonOf(packed, true).dump(2) << '\n';
        return;
    }
    std::string text = jsonOf(packed, false).dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<unsigned char>& data = packed.model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    const auto put = [&](std::initializer_list<uint32_t> words) {
        for (const uint32_t word : words) out.write(reinterpret_cast<const char*>(&word), sizeof word);
    };
    constexpr uint32_t magic = 0x46546c67, version = 2, jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;
    put({magic, version, static_cast<uint32_t>(12 + 8 + text.size() + 8 + data.size())});
    put({static_cast<uint32_t>(text.size()), jsonChunk});
    out << text;
    put({static_cast<uint32_t>(data.size()), binaryChunk});
    out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
}

}  // namespace sgm::exporter
