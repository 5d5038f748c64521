#include "modeler/tiles/cell_content.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace sgm::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr int floatType = 5126, uintType = 5125, arrayTarget = 34962, elementTarget = 34963;

/// One cell's file as it grows.
class CellFile {
public:
    explicit CellFile(const CellContent& content) : content_(content) {
        json()["asset"] = {{"version", "2.0"}, {"generator", "sgm"}};
        json()["scene"] = 0;
        json()["scenes"] = Json::array({{{"nodes", {0}}}});
        json()["nodes"] = Json::array({{{"name", "cell"}, {"children", Json::array()}}});
        for (const char* list : {"meshes", "materials", "accessors", "bufferViews"}) json()[list] = Json::array();
        json()["buffers"] = Json::array({{{"byteLength", 0}}});
    }

    void addGround() {
        if (content_.ground.empty()) return;
        Json primitives = Json::array();
        for (const GroundPiece& piece : content_.ground) {
            const int position = addAccessor(piece.positions, "VEC3", floatType, arrayTarget);
            Json& accessor = json()["accessors"][static_cast<size_t>(position)];
            Vec3f lo = piece.positions[0], hi = lo;
            for (const Vec3f& p : piece.positions) {
                lo = min(lo, p), hi = max(hi, p);
                take(p.as<double>());
            }
            accessor["min"] = {lo.x, lo.y, lo.z};
            accessor["max"] = {hi.x, hi.y, hi.z};
            primitives.push_back(
                {{"attributes",
                  {{"POSITION", position}, {"NORMAL", addAccessor(piece.normals, "VEC3", floatType, arrayTarget)}}},
                 {"indices", addAccessor(piece.indices, "SCALAR", uintType, elementTarget)},
                 {"material", materialOf(asJson(content_.materials[piece.material]))}});
            figures_.triangles += piece.indices.size() / 3;
        }
        addNode({{"name", "ground"}, {"mesh", json()["meshes"].size()}});
        json()["meshes"].push_back({{"name", "ground"}, {"primitives", primitives}});
    }

    Status addObject(const CellObject& object, Library& library) {
        const auto opened = library.open(object.path);
        if (!opened.ok()) return opened.error();
        const Glb& held = **opened;
        std::array<double, 6> box{};
        uint64_t triangles = 0;
        const int mesh = addLibraryMesh(object, held, box, triangles);
        std::vector<std::array<float, 3>> translations;
        std::vector<std::array<float, 4>> rotations;
        Json places = Json::array();
        for (const CellPlace& place : object.places) {
            const Vec3f at = (place.pose.origin - content_.centre).as<float>();
            const auto q = mesh::quaternionOf(place.pose.axes);
            translations.push_back({at.x, at.y, at.z});
            rotations.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                                 static_cast<float>(q[3])});
            places.push_back({{"path", place.part.path}, {"rule", place.part.rule}, {"line", place.part.line}});
            for (int corner = 0; corner < 8; ++corner)
                take(place.pose.origin - content_.centre +
                     place.pose.axes *
                         Vec3d{box[corner & 1 ? 3 : 0], box[corner & 2 ? 4 : 1], box[corner & 4 ? 5 : 2]});
        }
        figures_.instances += object.places.size();
        figures_.triangles += triangles * object.places.size();
        Json extras = Json::object();
        for (const auto& [name, value] : object.values) extras[name] = value;
        extras["places"] = std::move(places);
        const Json attributes{{"TRANSLATION", addAccessor(translations, "VEC3", floatType, 0)},
                              {"ROTATION", addAccessor(rotations, "VEC4", floatType, 0)}};
        addNode({{"name", held.json["meshes"][0].value("name", "object")},
                 {"mesh", mesh},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}},
                 {"extras", std::move(extras)}});
        return Done{};
    }

    CellFigures figures() const { return figures_; }

    Glb finish() {
        if (figures_.instances > 0) {
            json()["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
            json()["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
        }
        for (const char* list : {"materials", "accessors", "bufferViews"})
            if (json()[list].empty()) json().erase(list);
        return std::move(glb_);
    }

private:
    Json& json() { return glb_.json; }

    void take(Vec3d p) {
        auto& b = figures_.bounds;
        for (int i = 0; i < 3; ++i) {
            const auto at = static_cast<size_t>(i);
            b[at] = any_ ? std::min(b[at], p[i]) : p[i];
            b[at + 3] = any_ ? std::max(b[at + 3], p[i]) : p[i];
        }
        any_ = true;
    }

    void addNode(Json node) {
        json()["nodes"][0]["children"].push_back(json()["nodes"].size());
        json()["nodes"].push_back(std::move(node));
    }

    template <class T>
    int addAccessor(const std::vector<T>& numbers, const char* type, int component, int target) {
        Json view{{"buffer", 0}, {"byteOffset", glb_.bytes.size()}, {"byteLength", numbers.size() * sizeof(T)}};
        if (target != 0) view["target"] = target;
        const auto* from = reinterpret_cast<const uint8_t*>(numbers.data());
        glb_.bytes.insert(glb_.bytes.end(), from, from + numbers.size() * sizeof(T));
        json()["accessors"].push_back({{"bufferView", json()["bufferViews"].size()},
                                       {"componentType", component},
                                       {"count", numbers.size()},
                                       {"type", type}});
        json()["bufferViews"].push_back(std::move(view));
        return static_cast<int>(json()["accessors"].size()) - 1;
    }

    static Json asJson(const Material& m) {
        const auto digits = [](float v) { return std::round(static_cast<double>(v) * 1e6) / 1e6; };
        return {{"name", m.name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {digits(m.color.x), digits(m.color.y), digits(m.color.z), 1.0}},
                  {"roughnessFactor", digits(m.roughness)},
                  {"metallicFactor", digits(m.metallic)}}}};
    }

    /// The number of a material, added where no other is equal.
    size_t materialOf(Json material) {
        const auto [at, fresh] = materials_.try_emplace(material.dump(), json()["materials"].size());
        if (fresh) json()["materials"].push_back(std::move(material));
        return at->second;
    }

    /// The first mesh of a library file, whose bytes stay there.
    int addLibraryMesh(const CellObject& object, const Glb& held, std::array<double, 6>& box, uint64_t& triangles) {
        const size_t firstView = json()["bufferViews"].size(), firstAccessor = json()["accessors"].size();
        const size_t buffer = json()["buffers"].size();
        json()["buffers"].push_back({{"byteLength", held.fileBytes}, {"uri", object.file}});
        for (Json view : held.json["bufferViews"]) {
            view["buffer"] = buffer;
            view["byteOffset"] = view.value("byteOffset", uint64_t{0}) + held.bytesAt;
            json()["bufferViews"].push_back(std::move(view));
        }
        for (Json accessor : held.json["accessors"]) {
            accessor["bufferView"] = accessor["bufferView"].get<size_t>() + firstView;
            json()["accessors"].push_back(std::move(accessor));
        }
        Json mesh = held.json["meshes"][0];
        mesh.erase("extras");
        bool first = true;
        for (Json& primitive : mesh["primitives"]) {
            primitive.erase("extras");
            const Json& position = held.json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
            for (size_t i = 0; i < 3; ++i) {
                const double lo = position["min"][i], hi = position["max"][i];
                box[i] = first ? lo : std::min(box[i], lo);
                box[i + 3] = first ? hi : std::max(box[i + 3], hi);
            }
            first = false;
            triangles += held.json["accessors"][primitive["indices"].get<size_t>()]["count"].get<uint64_t>() / 3;
            for (auto& [name, index] : primitive["attributes"].items()) index = index.get<size_t>() + firstAccessor;
            primitive["indices"] = primitive["indices"].get<size_t>() + firstAccessor;
            primitive["material"] = materialOf(held.json["materials"][primitive["material"].get<size_t>()]);
        }
        json()["meshes"].push_back(std::move(mesh));
        return static_cast<int>(json()["meshes"].size()) - 1;
    }

    const CellContent& content_;
    Glb glb_;
    CellFigures figures_;
    bool any_ = false;
    std::map<std::string, size_t> materials_;  ///< by their text
};

/// Every triangle with a normal of its own where its neighbours lie in other planes.
void facet(GroundPiece& piece, const std::vector<uint32_t>& indices, const std::vector<Vec3f>& positions) {
    std::map<std::pair<uint32_t, std::array<int, 3>>, uint32_t> known;  // by vertex and rounded normal
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        const Vec3f &a = positions[indices[t]], &b = positions[indices[t + 1]], &c = positions[indices[t + 2]];
        const Vec3f across = cross(b - a, c - a);
        // A triangle without area covers nothing, but holds a vertex of the border that a neighbour has, too.
        const Vec3f normal = length(across) > 0 ? normalized(across) : Vec3f{0, 1, 0};
        const auto round = [](float v) { return static_cast<int>(std::lround(v * 1000)); };
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = indices[t + k];
            const auto [at, fresh] = known.try_emplace({vertex, {round(normal.x), round(normal.y), round(normal.z)}},
                                                       static_cast<uint32_t>(piece.positions.size()));
            if (fresh) {
                piece.positions.push_back(positions[vertex]);
                piece.normals.push_back(normal);
            }
            piece.indices.push_back(at->second);
        }
    }
}

}  // namespace

std::vector<GroundPiece> groundPieces(const mesh::PackedMesh& mesh, const std::vector<uint32_t>& triangles,
                                      const Provenance& provenance, Vec3d centre, float error_m) {
    std::map<uint32_t, std::vector<uint32_t>> byMaterial;  // vertices, three a triangle
    for (const uint32_t t : triangles) {
        const OriginId origin = mesh.origins[t];
        const uint32_t part = origin < provenance.parts.size() ? origin : 0;
        auto& list = byMaterial[provenance.parts[part].material];
        for (int k = 0; k < 3; ++k) list.push_back(mesh.triangles[t][k]);
    }
    std::vector<GroundPiece> pieces;
    for (const auto& [material, corners] : byMaterial) {
        std::unordered_map<uint32_t, uint32_t> local;
        std::vector<Vec3f> positions;
        std::vector<uint32_t> indices;
        for (const uint32_t vertex : corners) {
            const auto [at, fresh] = local.try_emplace(vertex, static_cast<uint32_t>(positions.size()));
            // Exact: positions and centre are multiples of a cell's share.
            if (fresh) positions.push_back((mesh.positions[vertex].as<double>() - centre).as<float>());
            indices.push_back(at->second);
        }
        std::vector<uint32_t> simple(indices.size());
        const float scale = meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(Vec3f));
        simple.resize(meshopt_simplify(simple.data(), indices.data(), indices.size(), &positions[0].x, positions.size(),
                                       sizeof(Vec3f), 0, scale > 0 ? error_m / scale : 0, meshopt_SimplifyLockBorder,
                                       nullptr));
        GroundPiece piece;
        piece.material = material;
        facet(piece, simple, positions);
        if (!piece.indices.empty()) pieces.push_back(std::move(piece));
    }
    return pieces;
}

Result<const Glb*> Library::open(const std::filesystem::path& path) {
    if (const auto known = known_.find(path); known != known_.end()) return &known->second;
    auto read = readGlb(path);
    if (!read.ok()) return read.error();
    read->bytes = {};
    if (!read->json.contains("meshes"))
        return Error{Error::Kind::Input, "'" + path.string() + "' holds no mesh: remove it, so that it is made anew"};
    return &known_.emplace(path, std::move(*read)).first->second;
}

Result<CellFigures> writeCell(const CellContent& content, Library& library, const std::filesystem::path& path) {
    CellFile file(content);
    file.addGround();
    for (const CellObject& object : content.objects)
        if (const Status s = file.addObject(object, library); !s.ok()) return s.error();
    const CellFigures figures = file.figures();
    if (figures.empty()) return figures;
    if (const Status s = writeGlb(file.finish(), path); !s.ok()) return s.error();
    return figures;
}

}  // namespace sgm::tiles
