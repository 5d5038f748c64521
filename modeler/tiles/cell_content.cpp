#include "modeler/tiles/cell_content.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "modeler/tiles/property_table.h"
#include "modeler/tiles/textures.h"

namespace sgm::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr int floatType = 5126;

/// One cell's file as it grows.
class CellFile {
public:
    explicit CellFile(const CellContent& content) : content_(content), file_(content.packing, content.pictures) {
        json()["scenes"].push_back({{"nodes", {0}}});
        json()["nodes"].push_back({{"name", "cell"}, {"children", Json::array()}});
        // Files that stand by themselves lie where the cell does; in a tileset the tile says where.
        const Vec3d c = content.centre;
        if (content.asNodes) json()["nodes"][0]["translation"] = {c.x, c.y, c.z};
    }

    void addGround() {
        if (content_.ground.empty()) return;
        for (const SurfacePiece& piece : content_.ground)
            for (const Vec3f& p : piece.positions) take(p.as<double>());
        figures_.triangles += trianglesOf(content_.ground);
        Json node{{"name", "ground"}, {"mesh", json()["meshes"].size()}};
        node.update(file_.placeOf(content_.groundGrid));
        addNode(std::move(node));
        json()["meshes"].push_back(
            {{"name", "ground"},
             {"primitives", file_.addPieces(content_.ground, content_.materials, content_.groundGrid)}});
    }

    Status addObject(const CellObject& object, Library& library) {
        const auto opened = library.open(object.path);
        if (!opened.ok()) return opened.error();
        const Library::Entry& held = **opened;
        const bool packed = content_.packing == Packing::Meshopt;
        const double step = packed ? held.grid.step.x : 1;
        std::vector<std::array<float, 3>> translations;
        std::vector<std::array<float, 4>> rotations;
        std::vector<float> features;
        for (const CellPlace& place : object.places) {
            const Pose& pose = place.part->pose;
            const Vec3d origin = pose.origin - content_.centre;
            // The node scales the grid's numbers and all that is done to them, so that no instance has to.
            const Vec3f at = ((packed ? origin + pose.axes * held.grid.origin : origin) / step).as<float>();
            const auto q = mesh::quaternionOf(pose.axes);
            translations.push_back({at.x, at.y, at.z});
            rotations.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                                 static_cast<float>(q[3])});
            features.push_back(static_cast<float>(rows_.size()));
            rows_.push_back(place.part);
            for (int corner = 0; corner < 8; ++corner)
                take(origin + pose.axes * Vec3d{corner & 1 ? held.box.hi.x : held.box.lo.x,
                                                corner & 2 ? held.box.hi.y : held.box.lo.y,
                                                corner & 4 ? held.box.hi.z : held.box.lo.z});
        }
        figures_.instances += object.places.size();
        figures_.triangles += held.triangles * object.places.size();
        size_t mesh = 0;
        try {
            mesh = addLibraryMesh(object, held.file());
        } catch (const Json::exception&) {  // a member of another type
            return damagedFile(object.path);
        }
        if (content_.asNodes) {
            for (size_t i = 0; i < object.places.size(); ++i)
                addNode(placeNode(object, *object.places[i].part, mesh, translations[i], rotations[i]));
            return Done{};
        }
        addNode(nodeOf(object, held, mesh, step,
                       {{"TRANSLATION", numbers(translations, "VEC3")},
                        {"ROTATION", numbers(rotations, "VEC4")},
                        {"_FEATURE_ID_0", numbers(features, "SCALAR")}}));
        return Done{};
    }

    /// One cube for each kind and material, which every place stretches: far cells hold thousands of places.
    void addBoxes() {
        std::map<std::pair<std::string, std::string>, std::vector<const CellBox*>> groups;
        for (const CellBox& box : content_.boxes) groups[{box.kind, asJson(box.material).dump()}].push_back(&box);
        for (const auto& [key, boxes] : groups) {
            std::vector<std::array<float, 3>> translations, scales;
            std::vector<std::array<float, 4>> rotations;
            std::vector<float> features;
            for (const CellBox* box : boxes) {
                const Pose& pose = box->part->pose;
                const Mat3 axes = pose.axes * box->axes;
                const Vec3d at = pose.origin - content_.centre + pose.axes * box->centre;
                const auto q = mesh::quaternionOf(axes);
                const Vec3f t = at.as<float>(), s = box->half.as<float>();
                translations.push_back({t.x, t.y, t.z});
                scales.push_back({s.x, s.y, s.z});
                rotations.push_back({static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                                     static_cast<float>(q[3])});
                features.push_back(static_cast<float>(rows_.size()));
                rows_.push_back(box->part);
                for (int corner = 0; corner < 8; ++corner)
                    take(at + axes * (box->half * Vec3d{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                                                        corner & 4 ? 1.0 : -1.0}));
            }
            figures_.instances += boxes.size();
            figures_.triangles += 12 * boxes.size();
            const Json attributes{{"TRANSLATION", numbers(translations, "VEC3")},
                                  {"ROTATION", numbers(rotations, "VEC4")},
                                  {"SCALE", numbers(scales, "VEC3")},
                                  {"_FEATURE_ID_0", numbers(features, "SCALAR")}};
            addNode({{"name", key.first},
                     {"mesh", cubeOf(boxes.front()->material)},
                     {"extensions", instancing(attributes, boxes.size())},
                     {"extras", {{"start", key.first}}}});
        }
    }

    CellFigures figures() const { return figures_; }

    Glb finish() {
        if (!rows_.empty() && !content_.asNodes) {
            addTable();
            file_.use("EXT_mesh_gpu_instancing", true);
            file_.use("EXT_instance_features", false);
        }
        return file_.finish();
    }

private:
    Json& json() { return file_.json(); }

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

    /// An accessor over numbers that instances have.
    template <class T>
    size_t numbers(const std::vector<T>& list, const char* type) {
        return file_.addAccessor(file_.addView(list.data(), list.size() * sizeof(T)), 0, floatType, list.size(), type);
    }

    static Json instancing(const Json& attributes, size_t count) {
        return {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}},
                {"EXT_instance_features",
                 {{"featureIds", Json::array({{{"featureCount", count}, {"attribute", 0}, {"propertyTable", 0}}})}}}};
    }

    /// The mesh of a cube from -1 to 1 in that material.
    size_t cubeOf(const Material& material) {
        SurfacePiece cube;
        for (int face = 0; face < 6; ++face) {
            const double sign = face % 2 ? 1 : -1;
            Vec3d out;
            out[face / 2] = sign;
            const Vec3d u{out.y, out.z, out.x}, v = cross(out, u);
            const auto first = static_cast<uint32_t>(cube.positions.size());
            for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
                cube.positions.push_back((out + u * a + v * b).as<float>());
                cube.normals.push_back(out.as<float>());
            }
            for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) cube.indices.push_back(first + corner);
        }
        json()["meshes"].push_back(
            {{"name", "box"}, {"primitives", file_.addPieces({cube}, {material}, {}, false, Packing::None)}});
        return json()["meshes"].size() - 1;
    }

    Json nodeOf(const CellObject& object, const Library::Entry& held, size_t mesh, double step,
                const Json& attributes) const {
        Json node{{"name", held.name}, {"mesh", mesh}};
        if (step != 1) node["scale"] = {step, step, step};
        node["extensions"] = instancing(attributes, object.places.size());
        node["extras"] = object.values;
        return node;
    }

    /// A place as a node of its own.
    static Json placeNode(const CellObject& object, const Part& part, size_t mesh, const std::array<float, 3>& at,
                          const std::array<float, 4>& turn) {
        Json extras = object.values;
        const std::string path = part.path.text();
        extras["path"] = path;
        if (!part.rule().empty()) extras["rule"] = part.rule();
        extras["file"] = part.file();
        extras["line"] = part.line();
        const size_t slash = path.rfind('/');
        return {{"name", slash == std::string::npos ? path : path.substr(slash + 1)},
                {"mesh", mesh},
                {"translation", at},
                {"rotation", turn},
                {"extras", std::move(extras)}};
    }

    /// The mesh of a library file, whose bytes stay there.
    size_t addLibraryMesh(const CellObject& object, const Glb& held) {
        const auto at = file_.addExternal(held, object.file);
        const std::string folder = std::filesystem::path(object.file).parent_path().string();
        Json mesh = held.json["meshes"][0];
        for (Json& primitive : mesh["primitives"]) {
            for (auto& [name, index] : primitive["attributes"].items()) index = index.get<size_t>() + at.firstAccessor;
            primitive["indices"] = primitive["indices"].get<size_t>() + at.firstAccessor;
            primitive["material"] = file_.materialOf(
                file_.adopted(held.json["materials"][primitive["material"].get<size_t>()], held, folder));
        }
        json()["meshes"].push_back(std::move(mesh));
        return json()["meshes"].size() - 1;
    }

    /// The places by feature: which shape, rule and line put what stands there.
    void addTable() {
        std::vector<std::string> paths, rules, files;
        std::vector<uint32_t> lines;
        for (const Part* part : rows_) {
            paths.push_back(part->path.text());
            rules.push_back(part->rule());
            files.push_back(std::filesystem::path(part->file()).filename().string());
            lines.push_back(part->line());
        }
        PropertyTable table("place");
        table.addColumn("path", std::move(paths));
        table.addColumn("rule", std::move(rules));
        table.addColumn("file", std::move(files));
        table.addColumn("line", std::move(lines));
        table.writeTo(file_);
    }

    const CellContent& content_;
    SurfaceBuffer file_;
    CellFigures figures_;
    bool any_ = false;
    std::vector<const Part*> rows_;  ///< of the table of places
};

/// What cells take over of a file's JSON.
Json withoutTheRest(const Json& json) {
    Json kept;
    for (const char* key : {"meshes", "accessors", "bufferViews", "materials", "textures", "images"})
        if (json.contains(key)) kept[key] = json[key];
    return kept;
}

/// Whether a file's mesh, accessors, views and materials lead to one another: what cells take over is looked up without
/// another look. Throws Json's exceptions.
bool isWhole(const Json& json) {
    const auto leads = [](const Json& index, const Json& list) {
        return index.is_number_unsigned() && index.get<uint64_t>() < list.size();
    };
    const Json &accessors = json.at("accessors"), &views = json.at("bufferViews"), &materials = json.at("materials");
    for (const Json& view : views) {
        if (!view.contains("extensions")) continue;
        const Json& packed = view["extensions"].at("EXT_meshopt_compression");
        if (!packed.at("byteOffset").is_number_unsigned() || !view.at("byteOffset").is_number_unsigned() ||
            !view.at("byteLength").is_number_unsigned())
            return false;
    }
    for (const Json& accessor : accessors)
        if (!leads(accessor.at("bufferView"), views) || !accessor.at("count").is_number_unsigned()) return false;
    for (const Json& primitive : json.at("meshes").at(0).at("primitives")) {
        if (!primitive.at("attributes").contains("POSITION") || !leads(primitive.at("indices"), accessors) ||
            !leads(primitive.at("material"), materials))
            return false;
        for (const Json& attribute : primitive["attributes"])
            if (!leads(attribute, accessors)) return false;
    }
    return json.at("nodes").at(0).is_object();
}

Library::Entry entryOf(const Glb& file) {
    const Json& json = file.json;
    Library::Entry entry;
    entry.grid.origin = vectorOf(json["nodes"][0], "translation", {});
    entry.grid.step = vectorOf(json["nodes"][0], "scale", {1, 1, 1});
    for (const Json& primitive : json["meshes"][0]["primitives"]) {
        const Json& position = json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
        entry.box.lo = entry.grid.origin + entry.grid.step * vectorOf(position, "min", {});
        entry.box.hi = entry.grid.origin + entry.grid.step * vectorOf(position, "max", {});
        entry.triangles += json["accessors"][primitive["indices"].get<size_t>()]["count"].get<uint64_t>() / 3;
    }
    entry.name = json["meshes"][0].value("name", "object");
    entry.json = Json::to_cbor(withoutTheRest(json));
    entry.json.shrink_to_fit();
    entry.bytesAt = file.bytesAt, entry.fileBytes = file.fileBytes;
    return entry;
}

Result<Library::Entry> readEntry(const std::filesystem::path& path) {
    const auto file = readGlb(path);
    if (!file.ok()) return file.error();
    try {
        if (isWhole(file->json)) return entryOf(*file);
    } catch (const Json::exception&) {  // a member that isn't there or of another type
    }
    return damagedFile(path);
}

}  // namespace

Status writeObject(const LibraryObject& object, Packing packing, const std::filesystem::path& path) {
    if (!object.inColors)
        if (const Status s = writePictures(object.materials, path.parent_path().parent_path() / "textures"); !s.ok())
            return s;
    SurfaceBuffer file(packing, "../textures/");
    const QuantizationGrid grid = gridOver(boundsOf(object.pieces));
    Json node{{"name", object.name}, {"mesh", 0}};
    node.update(file.placeOf(grid));
    node["extras"] = object.values;
    file.json()["scenes"].push_back({{"nodes", {0}}});
    file.json()["nodes"].push_back(std::move(node));
    file.json()["meshes"].push_back(
        {{"name", object.name},
         {"primitives", file.addPieces(object.pieces, object.materials, grid, object.inColors)}});
    return writeGlb(file.finish(), path);
}

Glb Library::Entry::file() const { return {Json::from_cbor(json), {}, bytesAt, fileBytes}; }

Result<const Library::Entry*> Library::open(const std::filesystem::path& path) {
    if (const auto known = recent_.find(path); known != recent_.end()) return &known->second;
    if (recent_.size() >= mostRecent) older_ = std::exchange(recent_, {});
    if (auto known = older_.extract(path)) return &recent_.insert(std::move(known)).position->second;
    auto read = readEntry(path);
    if (!read.ok()) return read.error();
    return &recent_.emplace(path, std::move(*read)).first->second;
}

Result<CellFigures> writeCell(const CellContent& content, Library& library, const std::filesystem::path& path) {
    CellFile file(content);
    file.addGround();
    for (const CellObject& object : content.objects)
        if (const Status s = file.addObject(object, library); !s.ok()) return s.error();
    file.addBoxes();
    const CellFigures figures = file.figures();
    if (figures.empty()) return figures;
    if (const Status s = writeGlb(file.finish(), path); !s.ok()) return s.error();
    return figures;
}

}  // namespace sgm::tiles
