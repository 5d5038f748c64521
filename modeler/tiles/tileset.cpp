#include "modeler/tiles/tileset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "modeler/core/atomic_file.h"
#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "modeler/core/regular_file.h"
#include "modeler/tiles/page.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr uint64_t mostFile_bytes = 4ull << 30;

std::optional<std::string> textOf(const fs::path& path) {
    auto read = readRegularFile(path, mostFile_bytes);
    return read.ok() ? std::optional(std::move(*read)) : std::nullopt;
}

Json asJson(const BakePlan& plan) {
    Json cells = Json::array();
    for (const Cell& cell : plan.cells) cells.push_back(cell.name());
    return {{"model", plan.model},
            {"name", plan.name},
            {"side_m", plan.side_m},
            {"cell_m", plan.cell_m},
            {"object_cell_m", plan.objectCell_m},
            {"errors_m", plan.errors_m},
            {"objects", plan.objects},
            {"places", plan.places},
            {"cells", std::move(cells)}};
}

/// What a text says that `sgm bake` wrote; throws where it has members of other types.
BakePlan planOf(const Json& json) {
    BakePlan plan;
    plan.model = json.value("model", "");
    plan.name = json.value("name", "");
    plan.side_m = json.value("side_m", 256.0);
    plan.cell_m = json.value("cell_m", 2.0);
    plan.objectCell_m = json.value("object_cell_m", .3);
    plan.errors_m = json.value("errors_m", std::vector<double>{});
    plan.objects = json.value("objects", uint64_t{0});
    plan.places = json.value("places", uint64_t{0});
    for (const Json& name : json["cells"])
        if (const auto cell = cellNamed(name.get<std::string>())) plan.cells.push_back(*cell);
    return plan;
}

/// Whether all cells are of levels that the plan has, and few enough levels that the tree over them is small.
bool isSound(const BakePlan& plan) {
    constexpr size_t mostLevels = 8;
    constexpr int farthest = 1 << 20;
    return !plan.errors_m.empty() && plan.errors_m.size() <= mostLevels && plan.side_m > 0 && plan.side_m <= 1e5 &&
           std::all_of(plan.cells.begin(), plan.cells.end(), [&](const Cell& cell) {
               return cell.level < static_cast<int>(plan.errors_m.size()) && cell.x >= -farthest &&
                      cell.x <= farthest && cell.z >= -farthest && cell.z <= farthest;
           });
}

/// A cell's note, as it was left.
struct Note {
    CellFigures figures;
    uint64_t bytes = 0;
    std::string digest;
};

Result<Note> readNote(const fs::path& folder, const Cell& cell) {
    const fs::path path = noteFile(folder, cell);
    const auto text = textOf(path);
    const Json json = text ? Json::parse(*text, nullptr, false) : Json();
    if (!json.is_object())
        return Error{
            Error::Kind::Input,
            fmt::format("'{}' isn't there yet: bake the cells that `sgm bake --missing` names", path.string())};
    try {
        Note note;
        note.figures.triangles = json.value("triangles", uint64_t{0});
        note.figures.instances = json.value("instances", uint64_t{0});
        note.figures.bounds = json.value("bounds", std::array<double, 6>{});
        note.bytes = json.value("bytes", uint64_t{0});
        note.digest = json.value("digest", "");
        return note;
    } catch (const Json::exception&) {  // a member of another type
        return Error{Error::Kind::Input,
                     fmt::format("'{}' is damaged: remove it and bake the cell anew", path.string())};
    }
}

/// A box as 3D Tiles has it: centre, then half axes; z up where the model's y is.
Json boxOf(const std::array<double, 6>& b) {
    const double x = (b[0] + b[3]) / 2, y = (b[1] + b[4]) / 2, z = (b[2] + b[5]) / 2;
    return {{"box", {x, -z, y, (b[3] - b[0]) / 2, 0, 0, 0, (b[5] - b[2]) / 2, 0, 0, 0, (b[4] - b[1]) / 2}}};
}

Json translation(Vec3d v) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, v.x, -v.z, v.y, 1}; }

/// East, north and up at a place of the ellipsoid WGS 84, by columns, and the place.
Json toEarth(const EarthPlace& at) {
    constexpr double a = 6378137.0, e2 = 6.69437999014e-3;
    const double lat = at.latitude_deg * pi / 180, lon = at.longitude_deg * pi / 180;
    const double sLat = std::sin(lat), cLat = std::cos(lat), sLon = std::sin(lon), cLon = std::cos(lon);
    const double n = a / std::sqrt(1 - e2 * sLat * sLat);
    return {-sLon,
            cLon,
            0,
            0,
            -sLat * cLon,
            -sLat * sLon,
            cLat,
            0,
            cLat * cLon,
            cLat * sLon,
            sLat,
            0,
            n * cLat * cLon,
            n * cLat * sLon,
            n * (1 - e2) * sLat,
            1};
}

/// The tree of tiles over the cells that have content.
class Tree {
public:
    Tree(const BakePlan& plan, const std::map<Cell, Note>& notes) : plan_(plan) {
        for (const auto& [cell, note] : notes)
            if (!note.figures.empty()) notes_.emplace(cell, note);
    }

    Json root() const {
        const int top = static_cast<int>(plan_.errors_m.size()) - 1;
        Json children = Json::array();
        std::array<double, 6> box{};
        bool any = false;
        for (const Cell& cell : plan_.cells) {
            if (cell.level != top) continue;
            Json tile = tileOf(cell, {});
            if (tile.is_null()) continue;
            const auto whole = boundsOf(cell);
            for (size_t i = 0; i < 6; ++i)
                box[i] = !any ? whole[i] : i < 3 ? std::min(box[i], whole[i]) : std::max(box[i], whole[i]);
            any = true;
            children.push_back(std::move(tile));
        }
        return {{"boundingVolume", boxOf(box)},
                {"geometricError", 8 * plan_.errors_m.back()},
                {"refine", "REPLACE"},
                {"children", std::move(children)}};
    }

private:
    std::array<Cell, 4> childrenOf(const Cell& c) const {
        const int level = c.level - 1;
        return {Cell{level, 2 * c.x, 2 * c.z}, Cell{level, 2 * c.x + 1, 2 * c.z}, Cell{level, 2 * c.x, 2 * c.z + 1},
                Cell{level, 2 * c.x + 1, 2 * c.z + 1}};
    }

    /// The box around a cell's content and all below it, in the model's frame; empty where there is none.
    std::array<double, 6> boundsOf(const Cell& cell) const {
        std::array<double, 6> box{1, 1, 1, -1, -1, -1};
        const auto add = [&](const std::array<double, 6>& other) {
            if (other[0] > other[3]) return;
            const bool first = box[0] > box[3];
            for (size_t i = 0; i < 6; ++i)
                box[i] = first ? other[i] : i < 3 ? std::min(box[i], other[i]) : std::max(box[i], other[i]);
        };
        if (const auto note = notes_.find(cell); note != notes_.end()) {
            const Vec3d c = cell.centre(plan_.side_m);
            std::array<double, 6> own = note->second.figures.bounds;
            for (size_t i = 0; i < 6; ++i) own[i] += i % 3 == 0 ? c.x : i % 3 == 2 ? c.z : 0;
            add(own);
        }
        if (cell.level > 0)
            for (const Cell& child : childrenOf(cell)) add(boundsOf(child));
        return box;
    }

    /// The tile of a cell in the frame of one that lies at `around`; null where nothing is in it.
    Json tileOf(const Cell& cell, Vec3d around) const {
        std::array<double, 6> box = boundsOf(cell);
        if (box[0] > box[3]) return nullptr;
        const Vec3d centre = cell.centre(plan_.side_m);
        for (size_t i = 0; i < 6; ++i) box[i] -= i % 3 == 0 ? centre.x : i % 3 == 2 ? centre.z : 0;
        Json tile{{"transform", translation(centre - around)},
                  {"boundingVolume", boxOf(box)},
                  {"geometricError", cell.level == 0 ? 0 : plan_.errors_m[static_cast<size_t>(cell.level)]},
                  {"refine", "REPLACE"}};
        if (notes_.contains(cell)) tile["content"] = {{"uri", "cells/" + cell.name() + ".glb"}};
        if (cell.level == 0) return tile;
        Json children = Json::array();
        for (const Cell& child : childrenOf(cell))
            if (Json below = tileOf(child, centre); !below.is_null()) children.push_back(std::move(below));
        if (!children.empty()) tile["children"] = std::move(children);
        return tile;
    }

    const BakePlan& plan_;
    std::map<Cell, Note> notes_;
};

/// Where an earlier merge put the city on the earth, as the tileset says it; null where it didn't.
Json transformIn(const fs::path& folder) {
    const auto text = textOf(folder / "tileset.json");
    const Json tileset = text ? Json::parse(*text, nullptr, false) : Json();
    const auto pointer = Json::json_pointer("/root/transform");
    if (!tileset.is_object() || !tileset.contains(pointer)) return {};
    const Json& transform = tileset.at(pointer);
    const bool isMatrix = transform.is_array() && transform.size() == 16 &&
                          std::all_of(transform.begin(), transform.end(), [](const Json& v) { return v.is_number(); });
    return isMatrix ? transform : Json();
}

Status checkDigest(const fs::path& folder, const Cell& cell, const Note& note) {
    if (note.figures.empty()) return Done{};
    const auto bytes = textOf(contentFile(folder, cell));
    if (bytes && digestOf(*bytes) == note.digest) return Done{};
    return Error{Error::Kind::Input,
                 fmt::format("'{}' {}: remove '{}' and bake the cell anew", contentFile(folder, cell).string(),
                             bytes ? "isn't as it was baked" : "is gone", noteFile(folder, cell).string())};
}

}  // namespace

fs::path planFile(const fs::path& folder) { return folder / "plan.json"; }
fs::path contentFile(const fs::path& folder, const Cell& cell) { return folder / "cells" / (cell.name() + ".glb"); }
fs::path noteFile(const fs::path& folder, const Cell& cell) { return folder / "cells" / (cell.name() + ".json"); }

std::string digestOf(std::string_view bytes) {
    uint64_t a = hashText(bytes), b = 0x9e3779b97f4a7c15ull;
    for (size_t i = 0; i < bytes.size(); i += 8) {
        uint64_t word = 0;
        for (size_t k = i; k < std::min(i + 8, bytes.size()); ++k)
            word = word << 8 | static_cast<unsigned char>(bytes[k]);
        b = combine(b, word);
    }
    a = combine(a, bytes.size());
    return fmt::format("{:016x}{:016x}", a, b);
}

Status checkPlan(const BakePlan& plan, const fs::path& folder) {
    const auto there = textOf(planFile(folder));
    if (!there || Json::parse(*there, nullptr, false) == asJson(plan)) return Done{};
    return Error{Error::Kind::Input,
                 fmt::format("'{}' is of another model or other settings: bake into another folder, or remove this one",
                             planFile(folder).string())};
}

Status keepPlan(const BakePlan& plan, const fs::path& folder) {
    std::error_code ignored;
    if (!fs::exists(planFile(folder), ignored)) return writeJson(planFile(folder), asJson(plan));
    return checkPlan(plan, folder);
}

Result<BakePlan> readPlan(const fs::path& folder) {
    const auto text = textOf(planFile(folder));
    const Json json = text ? Json::parse(*text, nullptr, false) : Json();
    if (!json.is_object() || !json.contains("cells"))
        return Error{Error::Kind::Input, fmt::format("'{}' {}", planFile(folder).string(),
                                                     text ? "can't be read" : "isn't there: run `sgm bake` first")};
    try {
        BakePlan plan = planOf(json);
        if (isSound(plan) && plan.cells.size() == json["cells"].size()) return plan;
    } catch (const Json::exception&) {  // a member of another type
    }
    return Error{Error::Kind::Input,
                 fmt::format("'{}' is damaged: bake into another folder", planFile(folder).string())};
}

Status noteCell(const fs::path& folder, const Cell& cell, const CellFigures& figures) {
    Json note{{"triangles", figures.triangles}, {"instances", figures.instances}};
    if (!figures.empty()) {
        const auto bytes = textOf(contentFile(folder, cell));
        if (!bytes) return writeError(contentFile(folder, cell), "it is gone");
        note["bounds"] = figures.bounds;
        note["bytes"] = bytes->size();
        note["digest"] = digestOf(*bytes);
    }
    return writeJson(noteFile(folder, cell), note);
}

bool isDone(const fs::path& folder, const Cell& cell) {
    std::error_code ignored;
    return fs::exists(noteFile(folder, cell), ignored);
}

Status merge(const fs::path& folder, const std::optional<EarthPlace>& at, bool verify) {
    const auto plan = readPlan(folder);
    if (!plan.ok()) return plan.error();
    std::map<Cell, Note> notes;
    Json cells = Json::object();
    uint64_t triangles = 0, bytes = 0, instances = 0;
    for (const Cell& cell : plan->cells) {
        auto note = readNote(folder, cell);
        if (!note.ok()) return note.error();
        if (verify)
            if (const Status s = checkDigest(folder, cell, *note); !s.ok()) return s;
        if (cell.level == 0) triangles += note->figures.triangles, instances += note->figures.instances;
        bytes += note->bytes;
        if (!note->figures.empty())
            cells[cell.name()] = {{"triangles", note->figures.triangles},
                                  {"instances", note->figures.instances},
                                  {"bytes", note->bytes},
                                  {"digest", note->digest}};
        notes.emplace(cell, std::move(*note));
    }
    Json library = Json::object();
    std::map<std::string, fs::path> files;
    std::error_code ignored;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "lib", ignored))
        if (entry.is_regular_file() && entry.path().extension() != ".tmp")
            files.emplace(fs::relative(entry.path(), folder / "lib").string(), entry.path());
    for (const auto& [name, path] : files) {
        const std::string held = textOf(path).value_or("");
        library[name] = {{"bytes", held.size()}, {"digest", digestOf(held)}};
        bytes += held.size();
    }
    Json root = Tree(*plan, notes).root();
    if (Json transform = at ? toEarth(*at) : transformIn(folder); !transform.is_null())
        root["transform"] = std::move(transform);
    const Json tileset{{"asset", {{"version", "1.1"}, {"generator", "sgm"}}},
                       {"geometricError", 16 * plan->errors_m.back()},
                       {"root", std::move(root)}};
    if (const Status s = writeJson(folder / "tileset.json", tileset); !s.ok()) return s;
    Json manifest{{"model", plan->model},   {"name", plan->name},     {"objects", plan->objects},
                  {"places", plan->places}, {"instances", instances}, {"triangles", triangles},
                  {"bytes", bytes}};
    if (fs::exists(folder / "plan.geojson", ignored)) manifest["plan"] = "plan.geojson";
    manifest["cells"] = std::move(cells);
    manifest["library"] = std::move(library);
    if (const Status s = writeJson(folder / "manifest.json", manifest); !s.ok()) return s;
    return writePage(folder);
}

}  // namespace sgm::tiles
