#include "modeler/tiles/read_back.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "modeler/image/texture.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// More elements than a packed byte ever stands for: the vertex codec packs 16 elements into a few bits at least.
constexpr size_t mostPerByte = 1024;

/// Thrown for what no bake wrote.
struct Broken {};

/// A number of a file that counts something; Json would turn others into one, -1 into 2⁶⁴ − 1.
size_t wholeNumber(const Json& json) {
    if (!json.is_number_unsigned()) throw Broken{};
    return json.get<size_t>();
}

/// The one under a key, or `fallback` where the object hasn't the key.
size_t wholeNumberOr(size_t fallback, const Json& object, const char* key) {
    return object.contains(key) ? wholeNumber(object[key]) : fallback;
}

/// The numbers of a file, by accessor. Throws nlohmann's exceptions, std::out_of_range and Broken.
class Numbers {
public:
    explicit Numbers(const Glb& glb) : glb_(glb) {}

    /// `components` an element.
    std::vector<double> of(size_t accessor, size_t components) const {
        const Json& facts = glb_.json.at("accessors").at(accessor);
        const size_t view = wholeNumber(facts.at("bufferView")), count = wholeNumber(facts.at("count")),
                     type = wholeNumber(facts.at("componentType"));
        const bool normalized = facts.value("normalized", false);
        const std::vector<uint8_t> bytes = viewOf(view);
        const size_t size = type == 5120 || type == 5121 ? 1 : type == 5123 ? 2 : 4;
        const Json& viewFacts = glb_.json.at("bufferViews").at(view);
        const size_t width = components * size;
        const size_t stride = wholeNumberOr(width, viewFacts, "byteStride");
        const size_t first = wholeNumberOr(0, facts, "byteOffset");
        if (stride < width || first > bytes.size() || count > (bytes.size() - first + stride - width) / stride)
            throw Broken{};
        std::vector<double> out;
        out.reserve(count * components);
        for (size_t i = 0; i < count; ++i)
            for (size_t c = 0; c < components; ++c) {
                const uint8_t* at = bytes.data() + first + i * stride + c * size;
                const double v = type == 5120   ? load<int8_t>(at)
                                 : type == 5121 ? load<uint8_t>(at)
                                 : type == 5123 ? load<uint16_t>(at)
                                 : type == 5125 ? load<uint32_t>(at)
                                                : static_cast<double>(load<float>(at));
                out.push_back(!normalized    ? v
                              : type == 5120 ? std::max(v / 127, -1.0)
                                             : v / (type == 5121 ? 255 : 65535));
            }
        return out;
    }
    /// Texts of a column of the table of places.
    std::vector<std::string> texts(const Json& column, size_t rows) const {
        const std::vector<uint8_t> bytes = viewOf(column.at("values")), ends = viewOf(column.at("stringOffsets"));
        if (rows >= ends.size() / 4) throw Broken{};
        std::vector<std::string> out;
        for (size_t i = 0; i < rows; ++i) {
            const auto from = load<uint32_t>(ends.data() + 4 * i), to = load<uint32_t>(ends.data() + 4 * i + 4);
            if (from > to || to > bytes.size()) throw Broken{};
            out.emplace_back(bytes.begin() + from, bytes.begin() + to);
        }
        return out;
    }
    std::vector<uint32_t> words(const Json& column, size_t rows) const {
        const std::vector<uint8_t> bytes = viewOf(column.at("values"));
        if (rows > bytes.size() / 4) throw Broken{};
        std::vector<uint32_t> out(rows);
        std::memcpy(out.data(), bytes.data(), 4 * rows);
        return out;
    }

private:
    template <class T>
    static T load(const uint8_t* from) {
        T value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }

    /// What meshoptimizer's decoders take: they don't judge it themselves.
    static bool isDecodable(size_t count, size_t stride, bool isTriangles, const std::string& filter) {
        if (isTriangles) return count % 3 == 0 && (stride == 2 || stride == 4) && filter.empty();
        if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
        return stride > 0 && stride <= 256 && stride % 4 == 0;
    }

    /// A view of the file's own buffer, unpacked.
    std::vector<uint8_t> viewOf(size_t index) const {
        const Json& view = glb_.json.at("bufferViews").at(index);
        const bool isPacked = view.contains("extensions");
        const Json& facts = isPacked ? view["extensions"].at("EXT_meshopt_compression") : view;
        const size_t offset = wholeNumberOr(0, facts, "byteOffset"), length = wholeNumber(facts.at("byteLength"));
        if (facts.at("buffer") != 0 || offset > glb_.bytes.size() || length > glb_.bytes.size() - offset)
            throw Broken{};
        const uint8_t* from = glb_.bytes.data() + offset;
        if (!isPacked) return {from, from + length};
        const size_t count = wholeNumber(facts.at("count")), stride = wholeNumber(facts.at("byteStride"));
        const bool isTriangles = facts.at("mode") == "TRIANGLES";
        const std::string filter = facts.value("filter", "");
        if (!isDecodable(count, stride, isTriangles, filter) || count / mostPerByte > length) throw Broken{};
        std::vector<uint8_t> out(count * stride);
        const int failed = isTriangles ? meshopt_decodeIndexBuffer(out.data(), count, stride, from, length)
                                       : meshopt_decodeVertexBuffer(out.data(), count, stride, from, length);
        if (failed != 0) throw Broken{};
        if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
        if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
        return out;
    }

    const Glb& glb_;
};

/// What decides an object, as its node tells it.
std::map<std::string, std::string> valuesOf(const Json& node) {
    if (!node.contains("extras")) return {};
    return node["extras"].get<std::map<std::string, std::string>>();
}

QuantizationGrid gridOf(const Json& node) {
    return {vectorOf(node, "translation", {}), vectorOf(node, "scale", {1, 1, 1})};
}

/// What covers a material, from the picture files beside that of the mesh; null where nothing does.
std::shared_ptr<const image::Texture> textureOf(const Json& material, const Glb& glb, const fs::path& folder) {
    image::Texture texture;
    bool any = false;
    const auto read = [&](const Json& where, const char* slot, image::ImageFilePtr& picture) {
        if (!where.contains(slot)) return;
        const Json& json = glb.json.at("textures").at(wholeNumber(where[slot].at("index")));
        const std::string uri = glb.json.at("images").at(wholeNumber(json.at("source"))).at("uri");
        auto file = image::readImageFile(folder / uri);
        if (!file.ok()) throw Broken{};
        picture = std::move(*file);
        const Json& scale = where[slot].at("extensions").at("KHR_texture_transform").at("scale");
        texture.width_m = 1 / scale.at(0).get<float>(), texture.height_m = 1 / scale.at(1).get<float>();
        any = true;
    };
    read(material.at("pbrMetallicRoughness"), "baseColorTexture", texture.color);
    read(material.at("pbrMetallicRoughness"), "metallicRoughnessTexture", texture.roughness);
    read(material, "normalTexture", texture.normals);
    return any ? std::make_shared<const image::Texture>(std::move(texture)) : nullptr;
}

Material materialOf(const Json& json, const Glb& glb, const fs::path& folder) {
    const Json& pbr = json.at("pbrMetallicRoughness");
    const Json& color = pbr.at("baseColorFactor");
    return {json.value("name", ""),
            {color.at(0).get<float>(), color.at(1).get<float>(), color.at(2).get<float>()},
            pbr.value("roughnessFactor", .8f),
            pbr.value("metallicFactor", 0.f),
            textureOf(json, glb, folder)};
}

/// Texture coordinates and tangents of those vertices, where a mesh has them.
void readCover(const Numbers& numbers, const Json& attributes, const std::vector<uint32_t>& vertices,
               SurfacePiece& piece) {
    const auto all = [&](const char* name, size_t components) {
        return attributes.contains(name) ? numbers.of(attributes[name], components) : std::vector<double>();
    };
    const auto uvs = all("TEXCOORD_0", 2), tangents = all("TANGENT", 4);
    for (const uint32_t v : vertices) {
        const auto at = [v](const std::vector<double>& list, size_t components, size_t c) {
            return static_cast<float>(list.at(components * v + c));
        };
        if (!uvs.empty()) piece.uvs.push_back({at(uvs, 2, 0), -at(uvs, 2, 1)});
        if (!tangents.empty())
            piece.tangents.push_back(normalized(Vec3f{at(tangents, 4, 0), at(tangents, 4, 1), at(tangents, 4, 2)}));
    }
}

/// The pieces of a mesh of the file's own, in metres.
std::vector<SurfacePiece> piecesOf(const Glb& glb, const Json& mesh, const QuantizationGrid& grid) {
    const Numbers numbers(glb);
    std::vector<SurfacePiece> pieces;
    for (const Json& primitive : mesh.at("primitives")) {
        const auto p = numbers.of(primitive.at("attributes").at("POSITION"), 3);
        const auto n = numbers.of(primitive.at("attributes").at("NORMAL"), 3);
        auto corners = numbers.of(primitive.at("indices"), 1);
        if (primitive.contains("extras")) {
            const size_t skirts = wholeNumberOr(0, primitive["extras"], "skirtTriangles");
            if (skirts > corners.size() / 3) throw Broken{};
            corners.resize(corners.size() - 3 * skirts);
        }
        SurfacePiece piece;
        const size_t material = wholeNumber(primitive.at("material"));
        if (material >= glb.json.at("materials").size()) throw Broken{};
        piece.material = static_cast<uint32_t>(material);
        std::vector<uint32_t> local(p.size() / 3, 0xffffffffu), used;  // primitives share their vertices
        for (const double corner : corners) {
            if (!(corner >= 0 && corner < double(local.size())) || n.size() != p.size()) throw Broken{};
            const auto vertex = static_cast<size_t>(corner);
            if (local[vertex] == 0xffffffffu) {
                local[vertex] = static_cast<uint32_t>(piece.positions.size());
                used.push_back(static_cast<uint32_t>(vertex));
                const Vec3d q{p[3 * vertex], p[3 * vertex + 1], p[3 * vertex + 2]};
                piece.positions.push_back((grid.origin + grid.step * q).as<float>());
                piece.normals.push_back(
                    normalized(Vec3d{n[3 * vertex], n[3 * vertex + 1], n[3 * vertex + 2]}).as<float>());
            }
            piece.indices.push_back(local[vertex]);
        }
        readCover(numbers, primitive["attributes"], used, piece);
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

Mat3 turnOf(const double* q) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

std::vector<Material> materialsOf(const Glb& glb, const fs::path& folder) {
    std::vector<Material> materials;
    for (const Json& json : glb.json.at("materials")) materials.push_back(materialOf(json, glb, folder));
    return materials;
}

/// A cell's table of places, by row.
std::deque<Part> partsOf(const Glb& glb) {
    std::deque<Part> parts;
    if (!glb.json.contains("extensions")) return parts;
    const Json& table = glb.json["extensions"].at("EXT_structural_metadata").at("propertyTables").at(0);
    const Json& columns = table.at("properties");
    const size_t rows = wholeNumber(table.at("count"));
    const Numbers numbers(glb);
    const auto paths = numbers.texts(columns.at("path"), rows), rules = numbers.texts(columns.at("rule"), rows),
               files = numbers.texts(columns.at("file"), rows);
    const auto lines = numbers.words(columns.at("line"), rows);
    for (size_t i = 0; i < rows; ++i) {
        Part& part = parts.emplace_back();
        part.path = paths[i];
        part.madeBy = std::make_shared<const PartSource>(PartSource{{}, rules[i], files[i], lines[i]});
    }
    return parts;
}

/// The places of a node's instances, whose poses go into their parts.
CellObject objectOf(const Glb& glb, const Json& node, const fs::path& path, Library& library, std::deque<Part>& parts) {
    const Numbers numbers(glb);
    const Json& attributes = node.at("extensions").at("EXT_mesh_gpu_instancing").at("attributes");
    const auto t = numbers.of(attributes.at("TRANSLATION"), 3), r = numbers.of(attributes.at("ROTATION"), 4),
               ids = numbers.of(attributes.at("_FEATURE_ID_0"), 1);
    const double step = vectorOf(node, "scale", {1, 1, 1}).x;
    CellObject object;
    // The accessors of an object's mesh lie in the buffer of its file.
    const Json& mesh = glb.json.at("meshes").at(wholeNumber(node.at("mesh")));
    const Json& position =
        glb.json["accessors"].at(wholeNumber(mesh.at("primitives").at(0).at("attributes").at("POSITION")));
    const Json& view = glb.json["bufferViews"].at(wholeNumber(position.at("bufferView")));
    const size_t buffer = view.contains("extensions")
                              ? wholeNumber(view["extensions"].at("EXT_meshopt_compression").at("buffer"))
                              : wholeNumber(view.at("buffer"));
    object.file = glb.json.at("buffers").at(buffer).at("uri");
    object.path = path.parent_path() / object.file;
    object.values = valuesOf(node);
    Vec3d origin;  // a packed mesh counts from its corner, and so do its places
    if (view.contains("extensions")) {
        const auto held = library.open(object.path);
        if (!held.ok()) throw Broken{};
        origin = (*held)->grid.origin;
    }
    for (size_t i = 0; i < ids.size(); ++i) {
        if (!(ids[i] >= 0 && ids[i] < double(parts.size()))) throw Broken{};
        Part& part = parts[static_cast<size_t>(ids[i])];
        const Mat3 turn = turnOf(&r.at(4 * i));
        part.pose = {Vec3d{t.at(3 * i), t.at(3 * i + 1), t.at(3 * i + 2)} * step - turn * origin, turn};
        object.places.push_back({&part});
    }
    return object;
}

template <class T, class Work>
Result<T> read(const fs::path& path, Work work) {
    const auto glb = readGlb(path);
    if (!glb.ok()) return glb.error();
    try {
        return work(*glb);
    } catch (const Broken&) {
    } catch (const nlohmann::json::exception&) {
    } catch (const std::out_of_range&) {
    }
    return damagedFile(path);
}

}  // namespace

Result<LibraryObject> readObject(const fs::path& path) {
    return read<LibraryObject>(path, [&](const Glb& glb) {
        const Json& node = glb.json.at("nodes").at(0);
        LibraryObject object;
        object.name = node.value("name", "object");
        object.values = valuesOf(node);
        object.materials = materialsOf(glb, path.parent_path());
        object.pieces = piecesOf(glb, glb.json.at("meshes").at(0), gridOf(node));
        return object;
    });
}

Result<ReadCell> readCell(const fs::path& path, Library& library) {
    return read<ReadCell>(path, [&](const Glb& glb) {
        ReadCell cell;
        const Json& buffers = glb.json.at("buffers");
        cell.content.packing = buffers.size() > 1 && !buffers[1].contains("uri") ? Packing::Meshopt : Packing::None;
        cell.content.materials = materialsOf(glb, path.parent_path());
        cell.parts = partsOf(glb);
        for (const Json& node : glb.json.at("nodes")) {
            if (!node.contains("mesh")) continue;
            if (node.contains("extensions"))
                cell.content.objects.push_back(objectOf(glb, node, path, library, cell.parts));
            else
                cell.content.ground = piecesOf(glb, glb.json.at("meshes").at(wholeNumber(node["mesh"])), gridOf(node));
        }
        return cell;
    });
}

Result<std::optional<Box3d>> groundBounds(const fs::path& path) {
    return read<std::optional<Box3d>>(path, [](const Glb& glb) -> std::optional<Box3d> {
        for (const Json& node : glb.json.at("nodes")) {
            if (!node.contains("mesh") || node.contains("extensions")) continue;
            const QuantizationGrid grid = gridOf(node);
            const Json& mesh = glb.json.at("meshes").at(wholeNumber(node["mesh"]));
            const size_t accessor = wholeNumber(mesh.at("primitives").at(0).at("attributes").at("POSITION"));
            const Json& position = glb.json.at("accessors").at(accessor);
            return Box3d{grid.origin + grid.step * vectorOf(position, "min", {}),
                         grid.origin + grid.step * vectorOf(position, "max", {})};
        }
        return std::nullopt;
    });
}

}  // namespace sgm::tiles
