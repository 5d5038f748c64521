// KHR_draco_mesh_compression, by Google's Draco: connectivity by edgebreaker, attributes predicted and entropy coded.
#include "modeler/export/gltf_draco.h"

#include <draco/compression/expert_encode.h>
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <bit>
#include <unordered_map>

#include "modeler/export/gltf_primitive.h"

namespace sgm::exporter {
namespace {

constexpr const char* extension = "KHR_draco_mesh_compression";
constexpr int gridBits = 16, normalBits = 8;
/// Of the encoder and the decoder: 10 is fastest, 0 packs most; below 3 little is won.
constexpr int speed = 3;

template <size_t n>
using Floats = std::array<float, n>;

struct HashOfBits {
    template <size_t n>
    size_t operator()(const Floats<n>& numbers) const {
        uint64_t hash = 0;
        // −0 and 0 are equal, so + 0 makes them one.
        for (const float v : numbers) hash = (hash ^ std::bit_cast<uint32_t>(v + 0.0f)) * 0x9e3779b97f4a7c15u;
        return static_cast<size_t>(hash ^ (hash >> 32));
    }
};

/// A mesh in Draco's terms: points are the primitive's vertices, and equal values of an attribute are stored once, so
/// that the encoder finds the surface connected across hard edges and charts.
class DracoMesh {
public:
    explicit DracoMesh(const PrimitiveData& data) {
        mesh.set_num_points(static_cast<uint32_t>(data.positions.size()));
        mesh.SetNumFaces(data.indices.size() / 3);
        for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
            const uint32_t* corner = &data.indices[3 * size_t{i}];
            mesh.SetFace(draco::FaceIndex(i),
                         {draco::PointIndex(corner[0]), draco::PointIndex(corner[1]), draco::PointIndex(corner[2])});
        }
    }

    /// Adds an attribute of floats with the value `value(key)` for each distinct key of the points; its number.
    template <size_t n, class Key, class Value>
    int add(draco::GeometryAttribute::Type type, size_t points, Key key, Value value) {
        std::unordered_map<Floats<n>, uint32_t, HashOfBits> known;
        std::vector<Floats<n>> values;
        std::vector<uint32_t> valueOf;
        for (size_t i = 0; i < points; ++i) {
            const auto [at, fresh] = known.try_emplace(key(i), static_cast<uint32_t>(values.size()));
            if (fresh) values.push_back(value(at->first));
            valueOf.push_back(at->second);
        }
        const int id = add(type, draco::DT_FLOAT32, n, false, values.size(), values.data());
        for (uint32_t i = 0; i < points; ++i)
            mesh.attribute(id)->SetPointMapEntry(draco::PointIndex(i), draco::AttributeValueIndex(valueOf[i]));
        return id;
    }

    /// Adds an attribute of which each point has a value of its own, kept bit for bit.
    int add(const std::string& name, const RawAttribute& raw) {
        const bool color = name.starts_with("COLOR_");
        const size_t points = raw.bytes.size() / raw.elementBytes;
        const int id =
            add(color ? draco::GeometryAttribute::COLOR : draco::GeometryAttribute::GENERIC, typeOf(raw.componentType),
                static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(raw.type))), raw.normalized,
                points, raw.bytes.data());
        for (uint32_t i = 0; i < points; ++i)
            mesh.attribute(id)->SetPointMapEntry(draco::PointIndex(i), draco::AttributeValueIndex(i));
        return id;
    }

    draco::Mesh mesh;

private:
    int add(draco::GeometryAttribute::Type type, draco::DataType numbers, size_t components, bool normalized,
            size_t count, const void* values) {
        const auto stride = static_cast<int64_t>(components) * draco::DataTypeLength(numbers);
        draco::GeometryAttribute layout;
        layout.Init(type, nullptr, static_cast<uint8_t>(components), numbers, normalized, stride, 0);
        const int id = mesh.AddAttribute(layout, false, static_cast<uint32_t>(count));
        mesh.attribute(id)->buffer()->Write(0, values, count * static_cast<size_t>(stride));
        return id;
    }

    static draco::DataType typeOf(int componentType) {
        switch (componentType) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return draco::DT_INT8;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return draco::DT_UINT8;
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return draco::DT_INT16;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return draco::DT_UINT16;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return draco::DT_UINT32;
            default:
                return draco::DT_FLOAT32;
        }
    }
};

Floats<3> asArray(Vec3f v) { return {v.x, v.y, v.z}; }

/// What one primitive becomes.
struct Encoded {
    std::vector<char> bytes;
    size_t points = 0, faces = 0;
    tinygltf::Value::Object ids;  ///< Draco's number of each attribute
    Box3d bounds;                 ///< of the positions as they are decoded
};

class PrimitiveEncoder {
public:
    PrimitiveEncoder(const PrimitiveData& data, const QuantizationGrid& grid, Vec3<int64_t> origin)
        : data_(data), grid_(grid), origin_(origin), mesh_(data), encoder_(mesh_.mesh) {
        encoder_.SetSpeedOptions(speed, speed);
        encoder_.SetTrackEncodedProperties(true);
    }

    Result<Encoded> run() {
        addPositions();
        const int normal = mesh_.add<3>(
            draco::GeometryAttribute::NORMAL, data_.normals.size(), [&](size_t i) { return asArray(data_.normals[i]); },
            [](const Floats<3>& n) { return n; });
        encoder_.SetAttributeQuantization(normal, normalBits);
        nameAttribute("NORMAL", normal);
        for (const auto& [name, uv] : data_.textureCoordinates) addTextureCoordinates(name, uv);
        for (const auto& [name, other] : data_.others) nameAttribute(name, mesh_.add(name, other));
        if (Status done = encode(draco::MESH_EDGEBREAKER_ENCODING); !done.ok()) return done.error();
        // Edgebreaker drops triangles two corners of which have one position.
        if (out_.faces != mesh_.mesh.num_faces())
            if (Status done = encode(draco::MESH_SEQUENTIAL_ENCODING); !done.ok()) return done.error();
        return std::move(out_);
    }

private:
    void nameAttribute(const std::string& name, int id) {
        out_.ids[name] = tinygltf::Value(static_cast<int>(mesh_.mesh.attribute(id)->unique_id()));
    }

    /// Positions are told apart as they are, and rounded to the grid afterwards: rounding joins none.
    void addPositions() {
        const int id = mesh_.add<3>(
            draco::GeometryAttribute::POSITION, data_.positions.size(),
            [&](size_t i) { return asArray(data_.positions[i]); },
            [&](const Floats<3>& p) {
                const Vec3<int64_t> steps = stepsFrom(grid_, {0, 0, 0}, {p[0], p[1], p[2]});
                const Vec3d rounded = steps.as<double>() * grid_.step;
                out_.bounds = hull(out_.bounds, rounded);
                return asArray(rounded.as<float>());
            });
        const Floats<3> corner = asArray((origin_.as<double>() * grid_.step).as<float>());
        encoder_.SetAttributeExplicitQuantization(id, gridBits, 3, corner.data(), rangeOf(grid_));
        nameAttribute("POSITION", id);
    }

    void addTextureCoordinates(const std::string& name, const std::vector<Floats<2>>& uv) {
        Floats<2> lo = uv[0], hi = uv[0];
        for (const Floats<2>& at : uv)
            for (size_t i = 0; i < 2; ++i) lo[i] = std::min(lo[i], at[i]), hi[i] = std::max(hi[i], at[i]);
        const QuantizationGrid grid = gridOver(static_cast<double>(std::max(hi[0] - lo[0], hi[1] - lo[1])));
        for (float& v : lo) v = static_cast<float>(static_cast<double>(grid.below(static_cast<double>(v))) * grid.step);
        const int id = mesh_.add<2>(
            draco::GeometryAttribute::TEX_COORD, uv.size(), [&](size_t i) { return uv[i]; },
            [](const Floats<2>& at) { return at; });
        encoder_.SetAttributeExplicitQuantization(id, gridBits, 2, lo.data(), rangeOf(grid));
        nameAttribute(name, id);
    }

    /// Divided by the greatest number of 16 bits it is the step, exactly.
    static float rangeOf(const QuantizationGrid& grid) { return static_cast<float>(grid.step * ((1 << gridBits) - 1)); }

    Status encode(int method) {
        draco::EncoderBuffer buffer;
        encoder_.SetEncodingMethod(method);
        if (const draco::Status done = encoder_.EncodeToBuffer(&buffer); !done.ok())
            return Error{Error::Kind::Input, fmt::format("Draco: {}", done.error_msg_string())};
        out_.bytes.assign(buffer.data(), buffer.data() + buffer.size());
        out_.points = encoder_.num_encoded_points();
        out_.faces = encoder_.num_encoded_faces();
        return Done{};
    }

    const PrimitiveData& data_;
    const QuantizationGrid grid_;
    const Vec3<int64_t> origin_;
    DracoMesh mesh_;
    draco::ExpertEncoder encoder_;
    Encoded out_;
};

/// The model with its surfaces packed, made beside the old one.
class DracoPacker {
public:
    DracoPacker(tinygltf::Model& model, Progress* progress) : model_(model), progress_(progress) {}

    Status run() {
        std::vector<MeshData> meshes(model_.meshes.size());
        float extent = 0;
        for (size_t i = 0; i < meshes.size(); ++i) {
            if (!isSurface(model_.meshes[i])) continue;
            auto read = readMesh(model_, model_.meshes[i]);
            if (!read.ok()) return read.error();
            meshes[i] = std::move(*read);
            extent = std::max(extent, maxComponent(meshes[i].bounds.size()));
        }
        grid_ = gridOver(static_cast<double>(extent));
        TakenData taken(model_);
        const auto copied = [&](const tinygltf::BufferView& old, std::span<const unsigned char> bytes) {
            const int view = addView(bytes);
            model_.bufferViews.back().byteStride = old.byteStride;
            model_.bufferViews.back().target = old.target;
            return view;
        };
        for (size_t i = 0; i < meshes.size(); ++i) {
            const Vec3<int64_t> origin =
                meshes[i].primitives.empty() ? Vec3<int64_t>{} : originOf(grid_, meshes[i].bounds);
            for (size_t k = 0; k < model_.meshes[i].primitives.size(); ++k) {
                if (cancelled(progress_)) return cancelledError();
                tinygltf::Primitive& primitive = model_.meshes[i].primitives[k];
                if (meshes[i].primitives.empty())
                    taken.keep(primitive, copied);
                else if (Status done = pack(primitive, meshes[i].primitives[k], origin); !done.ok())
                    return done;
            }
        }
        model_.extensionsUsed.emplace_back(extension);
        model_.extensionsRequired.emplace_back(extension);
        return Done{};
    }

private:
    Status pack(tinygltf::Primitive& primitive, const PrimitiveData& data, Vec3<int64_t> origin) {
        auto encoded = PrimitiveEncoder(data, grid_, origin).run();
        if (!encoded.ok()) return encoded.error();
        for (auto& [name, index] : primitive.attributes) {
            const auto other = data.others.find(name);
            if (other != data.others.end()) {
                index = addDecoded(other->second.type, other->second.componentType, encoded->points);
                model_.accessors.back().normalized = other->second.normalized;
                continue;
            }
            const int type = name.starts_with("TEXCOORD_") ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3;
            index = addDecoded(type, TINYGLTF_COMPONENT_TYPE_FLOAT, encoded->points);
        }
        tinygltf::Accessor& position = model_.accessors[static_cast<size_t>(primitive.attributes["POSITION"])];
        const auto& [lo, hi] = encoded->bounds;
        position.minValues = {lo.x, lo.y, lo.z};
        position.maxValues = {hi.x, hi.y, hi.z};
        primitive.indices = addDecoded(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 3 * encoded->faces);
        const int view =
            addView({reinterpret_cast<const unsigned char*>(encoded->bytes.data()), encoded->bytes.size()});
        primitive.extras = {};  // may count triangles in an order that is lost
        primitive.extensions[extension] = tinygltf::Value(tinygltf::Value::Object{
            {"bufferView", tinygltf::Value(view)}, {"attributes", tinygltf::Value(encoded->ids)}});
        return Done{};
    }

    /// An accessor whose data the decoder brings.
    int addDecoded(int type, int componentType, size_t count) {
        tinygltf::Accessor accessor;
        accessor.type = type;
        accessor.componentType = componentType;
        accessor.count = count;
        return addAccessor(model_, accessor);
    }

    int addView(std::span<const unsigned char> bytes) {
        auto& data = model_.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = bytes.size();
        data.insert(data.end(), bytes.begin(), bytes.end());
        model_.bufferViews.push_back(view);
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    tinygltf::Model& model_;
    Progress* progress_;
    QuantizationGrid grid_;
};

}  // namespace

Status packByDraco(tinygltf::Model& model, Progress* progress) { return DracoPacker(model, progress).run(); }

}  // namespace sgm::exporter
