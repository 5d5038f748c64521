#include "modeler/tiles/surface_buffer.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

namespace sgm::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* meshoptExtension = "EXT_meshopt_compression";
constexpr int byteType = 5120, unsignedByteType = 5121, shortType = 5123, uintType = 5125, floatType = 5126;
constexpr int arrayTarget = 34962, elementTarget = 34963;
constexpr int normalBits = 8;
constexpr int uvBits = 20;  ///< a millimetre at a kilometre

template <class T>
void append(std::vector<uint8_t>& bytes, const T& value) {
    bytes.resize(bytes.size() + sizeof value);
    std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

/// The piece with its triangles and vertices in an order that packs well; what it shows stays.
SurfacePiece ordered(const SurfacePiece& piece) {
    SurfacePiece out = piece;
    const size_t corners = piece.indices.size(), vertices = piece.positions.size();
    const size_t own = corners - 3 * size_t{piece.skirtTriangles};  // skirts stay behind the others
    meshopt_optimizeVertexCache(out.indices.data(), piece.indices.data(), own, vertices);
    meshopt_optimizeVertexCache(out.indices.data() + own, piece.indices.data() + own, corners - own, vertices);
    std::vector<uint32_t> order(vertices);
    const size_t used = meshopt_optimizeVertexFetchRemap(order.data(), out.indices.data(), corners, vertices);
    meshopt_remapIndexBuffer(out.indices.data(), out.indices.data(), corners, order.data());
    meshopt_remapVertexBuffer(out.positions.data(), piece.positions.data(), vertices, sizeof(Vec3f), order.data());
    meshopt_remapVertexBuffer(out.normals.data(), piece.normals.data(), vertices, sizeof(Vec3f), order.data());
    out.positions.resize(used), out.normals.resize(used);
    if (!piece.uvs.empty()) {
        meshopt_remapVertexBuffer(out.uvs.data(), piece.uvs.data(), vertices, sizeof piece.uvs[0], order.data());
        out.uvs.resize(used);
    }
    if (!piece.tangents.empty()) {
        meshopt_remapVertexBuffer(out.tangents.data(), piece.tangents.data(), vertices, sizeof(Vec3f), order.data());
        out.tangents.resize(used);
    }
    return out;
}

}  // namespace

Vec3<uint16_t> QuantizationGrid::nearest(Vec3d p) const {
    Vec3<uint16_t> at;
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = static_cast<uint16_t>(std::clamp(std::round((p[axis] - origin[axis]) / step[axis]), 0.0, 65535.0));
    return at;
}

double stepOver(double extent) {
    if (!(extent > 0) || !std::isfinite(extent)) return 1;
    return std::ldexp(1, static_cast<int>(std::ceil(std::log2(extent / 65534))));
}

QuantizationGrid gridOver(const Box3f& box) {
    if (box.empty()) return {};
    const double step = stepOver(static_cast<double>(maxComponent(box.hi - box.lo)));
    QuantizationGrid grid{{}, {step, step, step}};
    for (int axis = 0; axis < 3; ++axis)
        grid.origin[axis] = std::floor(static_cast<double>(box.lo[axis]) / step) * step;
    return grid;
}

/// Pieces as one list of vertices.
struct SurfaceBuffer::Joined {
    std::vector<SurfacePiece> pieces;
    size_t vertices = 0, corners = 0;
    bool hasUvs = false, hasTangents = false;
};

SurfaceBuffer::SurfaceBuffer(Packing packing, std::string pictures)
    : packing_(packing), pictures_(std::move(pictures)) {
    json()["asset"] = {{"version", "2.0"}, {"generator", "sgm"}};
    json()["scene"] = 0;
    json()["scenes"] = Json::array();
    json()["nodes"] = Json::array();
    for (const char* list : {"meshes", "materials", "accessors", "bufferViews"}) json()[list] = Json::array();
    json()["buffers"] = Json::array({{{"byteLength", 0}}});
    if (packing == Packing::None) return;
    json()["buffers"].push_back({{"byteLength", 0}, {"extensions", {{meshoptExtension, {{"fallback", true}}}}}});
    // The format's decoders want this version; it is the library's state, not an argument.
    static std::once_flag version;
    std::call_once(version, [] { meshopt_encodeIndexVersion(1); });
}

size_t SurfaceBuffer::addView(const void* bytes, size_t size, int target, size_t align) {
    glb_.bytes.resize((glb_.bytes.size() + align - 1) / align * align);
    Json view{{"buffer", 0}, {"byteOffset", glb_.bytes.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    const auto* from = static_cast<const uint8_t*>(bytes);
    glb_.bytes.insert(glb_.bytes.end(), from, from + size);
    json()["bufferViews"].push_back(std::move(view));
    return json()["bufferViews"].size() - 1;
}

size_t SurfaceBuffer::addPacked(const std::vector<uint8_t>& bytes, size_t stride, size_t count, const char* mode,
                                const char* filter, int target) {
    glb_.bytes.resize((glb_.bytes.size() + 3) / 4 * 4);
    unpacked_ = (unpacked_ + 3) / 4 * 4;
    Json packed{{"buffer", 0},
                {"byteOffset", glb_.bytes.size()},
                {"byteLength", bytes.size()},
                {"byteStride", stride},
                {"count", count},
                {"mode", mode}};
    if (filter) packed["filter"] = filter;
    glb_.bytes.insert(glb_.bytes.end(), bytes.begin(), bytes.end());
    Json view{{"buffer", 1}, {"byteOffset", unpacked_}, {"byteLength", stride * count}};
    if (target == arrayTarget) view["byteStride"] = stride;
    view["target"] = target;
    view["extensions"][meshoptExtension] = std::move(packed);
    unpacked_ += stride * count;
    json()["bufferViews"].push_back(std::move(view));
    use(meshoptExtension, true);
    use("KHR_mesh_quantization", true);
    return json()["bufferViews"].size() - 1;
}

size_t SurfaceBuffer::addAccessor(size_t view, size_t offset, int component, size_t count, const char* type,
                                  bool normalized) {
    Json accessor{{"bufferView", view}};
    if (offset > 0) accessor["byteOffset"] = offset;
    accessor["componentType"] = component;
    if (normalized) accessor["normalized"] = true;
    accessor["count"] = count;
    accessor["type"] = type;
    json()["accessors"].push_back(std::move(accessor));
    return json()["accessors"].size() - 1;
}

size_t SurfaceBuffer::addPositions(const Joined& joined, const QuantizationGrid& grid) {
    std::vector<uint8_t> bytes;
    Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
    for (const SurfacePiece& piece : joined.pieces)
        for (const Vec3f& p : piece.positions) {
            if (packing_ == Packing::None) {
                append(bytes, p);
                lo = min(lo, p.as<double>()), hi = max(hi, p.as<double>());
            } else {
                const Vec3<uint16_t> q = grid.nearest(p.as<double>());
                append(bytes, std::array<uint16_t, 4>{q.x, q.y, q.z, 0});
                lo = min(lo, q.as<double>()), hi = max(hi, q.as<double>());
            }
        }
    const bool plain = packing_ == Packing::None;
    const size_t view = addVertices(bytes, 8, joined.vertices, nullptr);
    const size_t accessor = addAccessor(view, 0, plain ? floatType : shortType, joined.vertices, "VEC3");
    json()["accessors"][accessor]["min"] = {lo.x, lo.y, lo.z};
    json()["accessors"][accessor]["max"] = {hi.x, hi.y, hi.z};
    return accessor;
}

size_t SurfaceBuffer::addNormals(const Joined& joined) {
    std::vector<uint8_t> bytes;
    for (const SurfacePiece& piece : joined.pieces)
        for (const Vec3f& n : piece.normals) {
            if (packing_ == Packing::None) {
                append(bytes, n);
                continue;
            }
            const float unit[4] = {n.x, n.y, n.z, 0};
            uint32_t encoded = 0;
            meshopt_encodeFilterOct(&encoded, 1, sizeof encoded, normalBits, unit);
            append(bytes, encoded);
        }
    const bool plain = packing_ == Packing::None;
    const size_t view = addVertices(bytes, 4, joined.vertices, "OCTAHEDRAL");
    return addAccessor(view, 0, plain ? floatType : byteType, joined.vertices, "VEC3", !plain);
}

size_t SurfaceBuffer::addColors(const Joined& joined, const std::vector<Material>& materials) {
    std::vector<uint8_t> bytes;
    const auto byte = [](float v) { return static_cast<uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    for (const SurfacePiece& piece : joined.pieces) {
        const Vec3f c = materials[piece.material].color;
        for (size_t i = 0; i < piece.positions.size(); ++i)
            append(bytes, std::array<uint8_t, 4>{byte(c.x), byte(c.y), byte(c.z), 255});
    }
    return addAccessor(addVertices(bytes, 4, joined.vertices, nullptr), 0, unsignedByteType, joined.vertices, "VEC4",
                       true);
}

/// The view of numbers that vertices have.
size_t SurfaceBuffer::addVertices(const std::vector<uint8_t>& bytes, size_t stride, size_t count, const char* filter) {
    if (packing_ == Packing::None) return addView(bytes.data(), bytes.size(), arrayTarget);
    std::vector<uint8_t> packed(meshopt_encodeVertexBufferBound(count, stride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), count, stride));
    return addPacked(packed, stride, count, "ATTRIBUTES", filter, arrayTarget);
}

/// Metres, v downwards as glTF has it; none where no picture covers a vertex.
size_t SurfaceBuffer::addUvs(const Joined& joined) {
    std::vector<uint8_t> bytes;
    for (const SurfacePiece& piece : joined.pieces)
        for (size_t i = 0; i < piece.positions.size(); ++i) {
            const std::array<float, 2> uv = piece.uvs.empty() ? std::array<float, 2>{} : piece.uvs[i];
            const std::array<float, 2> down{uv[0], -uv[1]};
            if (packing_ == Packing::None) {
                append(bytes, down);
                continue;
            }
            std::array<uint32_t, 2> encoded{};
            meshopt_encodeFilterExp(encoded.data(), 1, sizeof encoded, uvBits, down.data());
            append(bytes, encoded);
        }
    return addAccessor(addVertices(bytes, 8, joined.vertices, "EXPONENTIAL"), 0, floatType, joined.vertices, "VEC2");
}

size_t SurfaceBuffer::addTangents(const Joined& joined) {
    const bool plain = packing_ == Packing::None;
    std::vector<uint8_t> bytes;
    for (const SurfacePiece& piece : joined.pieces)
        for (size_t i = 0; i < piece.positions.size(); ++i) {
            const Vec3f t = piece.tangents.empty() ? Vec3f{1, 0, 0} : piece.tangents[i];
            const std::array<float, 4> tangent{t.x, t.y, t.z, 1};
            uint32_t encoded = 0;
            meshopt_encodeFilterOct(&encoded, 1, sizeof encoded, normalBits, tangent.data());
            if (plain)
                append(bytes, tangent);
            else
                append(bytes, encoded);
        }
    const size_t view = addVertices(bytes, plain ? 16 : 4, joined.vertices, "OCTAHEDRAL");
    return addAccessor(view, 0, plain ? floatType : byteType, joined.vertices, "VEC4", !plain);
}

/// The view of all indices, 16 bits each where that does.
size_t SurfaceBuffer::addIndices(const Joined& joined) {
    std::vector<uint32_t> all;
    all.reserve(joined.corners);
    uint32_t first = 0;
    for (const SurfacePiece& piece : joined.pieces) {
        for (const uint32_t i : piece.indices) all.push_back(first + i);
        first += static_cast<uint32_t>(piece.positions.size());
    }
    const size_t stride = joined.vertices < 65535 ? 2 : 4;
    if (packing_ == Packing::Meshopt) {
        std::vector<uint8_t> packed(meshopt_encodeIndexBufferBound(all.size(), joined.vertices));
        packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), all.data(), all.size()));
        return addPacked(packed, stride, all.size(), "TRIANGLES", nullptr, elementTarget);
    }
    if (stride == 4) return addView(all.data(), all.size() * stride, elementTarget);
    const std::vector<uint16_t> narrow(all.begin(), all.end());
    return addView(narrow.data(), narrow.size() * stride, elementTarget);
}

Json SurfaceBuffer::addPieces(const std::vector<SurfacePiece>& pieces, const std::vector<Material>& materials,
                              const QuantizationGrid& grid, bool inColors, std::optional<Packing> packing) {
    const Packing own = std::exchange(packing_, packing.value_or(packing_));
    Json primitives = addJoined(pieces, materials, grid, inColors);
    packing_ = own;
    return primitives;
}

Json SurfaceBuffer::addJoined(const std::vector<SurfacePiece>& pieces, const std::vector<Material>& materials,
                              const QuantizationGrid& grid, bool inColors) {
    Joined joined;
    for (const SurfacePiece& piece : pieces) {
        if (piece.indices.empty()) continue;
        joined.pieces.push_back(packing_ == Packing::None ? piece : ordered(piece));
        joined.vertices += joined.pieces.back().positions.size();
        joined.corners += piece.indices.size();
        joined.hasUvs |= !inColors && !piece.uvs.empty();
        joined.hasTangents |= !inColors && !piece.tangents.empty();
    }
    Json primitives = Json::array();
    if (joined.corners == 0) return primitives;
    Json attributes{{"POSITION", addPositions(joined, grid)}, {"NORMAL", addNormals(joined)}};
    if (inColors) attributes["COLOR_0"] = addColors(joined, materials);
    const size_t indices = addIndices(joined);
    const int component = joined.vertices < 65535 ? shortType : uintType;
    if (inColors) {
        const Material colors{"colors", {1, 1, 1}, .85f, 0, nullptr};
        primitives.push_back({{"attributes", attributes},
                              {"indices", addAccessor(indices, 0, component, joined.corners, "SCALAR")},
                              {"material", materialOf(asJson(colors))}});
        return primitives;
    }
    const size_t uvs = joined.hasUvs ? addUvs(joined) : 0, tangents = joined.hasTangents ? addTangents(joined) : 0;
    size_t first = 0;
    for (const SurfacePiece& piece : joined.pieces) {
        const size_t accessor =
            addAccessor(indices, first * (component == shortType ? 2 : 4), component, piece.indices.size(), "SCALAR");
        const Material& material = materials[piece.material];
        Json own = attributes;
        if (!piece.uvs.empty()) own["TEXCOORD_0"] = uvs;
        if (!piece.tangents.empty()) own["TANGENT"] = tangents;
        primitives.push_back({{"attributes", std::move(own)},
                              {"indices", accessor},
                              {"material", materialOf(piece.uvs.empty() ? asJson(material) : covered(material))}});
        if (piece.skirtTriangles > 0) primitives.back()["extras"] = {{"skirtTriangles", piece.skirtTriangles}};
        first += piece.indices.size();
    }
    return primitives;
}

Json SurfaceBuffer::placeOf(const QuantizationGrid& grid) const {
    if (packing_ == Packing::None) return Json::object();
    return {{"translation", {grid.origin.x, grid.origin.y, grid.origin.z}},
            {"scale", {grid.step.x, grid.step.y, grid.step.z}}};
}

SurfaceBuffer::External SurfaceBuffer::addExternal(const Glb& held, const std::string& uri) {
    const External at{json()["bufferViews"].size(), json()["accessors"].size()};
    const size_t buffer = json()["buffers"].size();
    json()["buffers"].push_back({{"byteLength", held.fileBytes}, {"uri", uri}});
    const size_t unpackedBefore = unpacked_ = (unpacked_ + 3) / 4 * 4;
    for (Json view : held.json["bufferViews"]) {
        if (view.contains("extensions")) {
            Json& packed = view["extensions"][meshoptExtension];
            packed["buffer"] = buffer;
            packed["byteOffset"] = packed["byteOffset"].get<uint64_t>() + held.bytesAt;
            view["byteOffset"] = view["byteOffset"].get<uint64_t>() + unpackedBefore;
            unpacked_ = std::max(unpacked_, view["byteOffset"].get<size_t>() + view["byteLength"].get<size_t>());
            use(meshoptExtension, true);
            use("KHR_mesh_quantization", true);
        } else {
            view["buffer"] = buffer;
            view["byteOffset"] = view.value("byteOffset", uint64_t{0}) + held.bytesAt;
        }
        json()["bufferViews"].push_back(std::move(view));
    }
    for (Json accessor : held.json["accessors"]) {
        accessor["bufferView"] = accessor["bufferView"].get<size_t>() + at.firstView;
        json()["accessors"].push_back(std::move(accessor));
    }
    return at;
}

void SurfaceBuffer::use(const char* extension, bool required) { extensions_[extension] |= required; }

Glb SurfaceBuffer::finish() {
    for (const auto& [name, required] : extensions_) {
        json()["extensionsUsed"].push_back(name);
        if (required) json()["extensionsRequired"].push_back(name);
    }
    if (packing_ == Packing::Meshopt) json()["buffers"][1]["byteLength"] = std::max<size_t>(unpacked_, 1);
    for (const char* list : {"meshes", "materials", "accessors", "bufferViews"})
        if (json()[list].empty()) json().erase(list);
    return std::move(glb_);
}

}  // namespace sgm::tiles
