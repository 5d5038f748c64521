#include "modeler/export/exporter.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "modeler/core/atomic_file.h"
#include "modeler/export/formats.h"

namespace sgm::exporter {
namespace {

constexpr ExportOption uv{
    "uv", "scope", "scope|box|none",
    "texture coordinates in metres: in the plane of each face, turned with the scope of its shape, "
    "or projected along the nearest axis"};
constexpr ExportOption lightMap{"lightmap", "none", "none|256|512|1024|2048|4096",
                                "a second set of texture coordinates, without overlaps, for a light map of so many "
                                "texels a side for each object"};
constexpr ExportOption up{"up", "y", "y|z", "the axis that points up in the file"};
constexpr ExportOption unit{"unit", "m", "m|cm|mm", "the length of one unit in the file"};
constexpr std::string_view instancesDoc = "whether objects that are equal and touch nothing show one surface";
constexpr ExportOption gltfOptions[] = {
    uv,
    lightMap,
    {"instances", "yes", "yes|no", instancesDoc},
    {"engine", "godot", "godot|unreal|unity", "whose names colliders bear, so that it imports them as such"},
    {"pack", "none", "none|meshopt|draco",
     "compression, for readers that have it: 16-bit positions on one grid, 8-bit normals"},
    {"levels", "scene", "scene|msft",
     "where coarser levels of detail are: in the scene beside the finest, or outside, for readers of MSFT_lod alone"}};
constexpr ExportOption texturedOptions[] = {up, unit, uv};
constexpr ExportOption usdOptions[] = {up, unit, uv, lightMap, {"instances", "no", "yes|no", instancesDoc}};
constexpr ExportOption plainOptions[] = {up, unit};
constexpr ExportOption scadOptions[] = {
    up, unit, {"sides", "128", "16|32|64|128|256|512|1024|2048|4096", "sides of round solids, inscribed"}};
constexpr ExportOption plyOptions[] = {
    up,
    unit,
    {"attributes", "all", "all|none",
     "what vertices and faces carry beside the shape; none: 19 bytes a triangle, not 34"}};
constexpr ExportOption volumeOptions[] = {
    {"grids", "levelset", "levelset|fog|levelset,fog", "which grids the file holds; the fog's is called density"},
    {"grid", "level_set", "", "name of the level set's grid"},
    {"distance", "exact", "exact|raw",
     "level set: distances to the isosurface, or the field's own values, which are steeper or flatter in places"},
    {"half", "no", "no|yes", "16-bit floats: about a third smaller, three digits"},
    {"density", "1", "", "fog: density deep inside", 1e-6, 1e6},
    {"edge", "0", "", "fog: metres of depth over which it thickens to that; 0: three voxels", 0, 1e5},
    {"wisps", "0", "", "fog: how far noise eats into the edge", 0, 0.95},
    {"billow", "0", "", "fog: how much noise thins the inside, which is then stored voxel by voxel", 0, 1},
    {"lump", "0", "", "fog: metres of the largest lumps of noise; 0: an eighth of the least extent", 0, 1e5},
};

bool always(const ExportOptions&) { return true; }

bool withoutAttributes(const ExportOptions& options) {
    const auto asked = options.find("attributes");
    return asked != options.end() && asked->second == "none";
}

constexpr Exporter table[] = {
    {".glb", "glTF 2.0, binary: normals, texture coordinates, a primitive a material", false, gltfOptions, nullptr,
     writeGlb, nullptr, false, true, true},
    {".gltf", "glTF 2.0 as JSON, with its buffer inside", false, gltfOptions, nullptr, writeGltf, nullptr, false, true,
     true},
    {".obj", "Wavefront OBJ, with a .mtl beside it", false, texturedOptions, nullptr, writeObj, nullptr, false, true,
     true},
    {".ply", "PLY, binary: normals, texture coordinates s t, colours, an origin a face", false, plyOptions,
     withoutAttributes, writePly, streamPly},
    {".stl", "STL, binary: positions only", false, plainOptions, always, writeStl, streamStl},
    {".off", "OFF: positions and triangles as text", false, plainOptions, always, writeOff, streamOff},
    {".usda", "OpenUSD as text: normals, display colours, a subset and preview surface a material", false, usdOptions,
     nullptr, writeUsda, nullptr, false, true, true},
    {".vdb", "OpenVDB: a narrow-band level set, fog for renderers, or both; voxels in metres", true, volumeOptions,
     always, writeVdb, nullptr},
    {".csg.json",
     "The solid tree as JSON: booleans of primitives with their parts and materials, of models that are exactly that",
     false,
     {},
     always,
     writeCsgJson,
     nullptr,
     true},
    {".scad", "The solid tree as an OpenSCAD program: a module a boolean, of the same models", false, scadOptions,
     always, writeScad, nullptr, true},
};

/// The name in lower case, by ASCII.
std::string lowered(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// `parts`, each turned to text by `name`, with `separator` between them.
template <class Parts, class Name>
std::string joined(const Parts& parts, std::string_view separator, Name name) {
    std::string text;
    for (const auto& part : parts) {
        if (!text.empty()) text += separator;
        text += name(part);
    }
    return text;
}

/// True when `choices` ("y|z") has `value`; every value will do where there are none.
bool allowed(std::string_view choices, std::string_view value) {
    if (choices.empty()) return true;
    for (size_t begin = 0; begin <= choices.size();) {
        const size_t end = std::min(choices.find('|', begin), choices.size());
        if (choices.substr(begin, end - begin) == value) return true;
        begin = end + 1;
    }
    return false;
}

/// Why the option doesn't take `value`, "" where it does.
std::string refusal(const ExportOption& option, const std::string& value) {
    if (!allowed(option.choices, value)) return fmt::format("is one of {}, not '{}'", option.choices, value);
    if (option.lo >= option.hi) return {};
    const std::optional<double> number = numberOf(value);
    if (!number) return fmt::format("is a number, not '{}'", value);
    if (*number < option.lo || *number > option.hi)
        return fmt::format("is from {} to {}, not {}", option.lo, option.hi, value);
    return {};
}

Error bareError(const Path& path) { return writeError(path, "the mesh has no normals and origins"); }

Status checkInput(const ExportInput& input, const Exporter& row, const Path& path) {
    if (row.wantsVolume && !input.volume) return writeError(path, "there is no volume");
    if (row.wantsSolids && !input.solids) return writeError(path, "there is no solid tree");
    if (!row.wantsVolume && !row.wantsSolids && (!input.mesh || input.mesh->triangleCount() == 0))
        return writeError(path, "the mesh has no triangles");
    if (Status status = checkOptions(row, input.options); !status.ok()) return status;
    if (input.mesh && !takesBare(row, input.options) && input.mesh->isBare()) return bareError(path);
    return Done{};
}

/// The format of a path.
Result<const Exporter*> rowFor(const Path& path) {
    if (const Exporter* const row = exporterFor(path)) return row;
    return Error{Error::Kind::Usage, fmt::format("no format for '{}'; the extensions are {}", path.string(),
                                                 joined(table, " ", [](const Exporter& e) { return e.extension; }))};
}

/// Replaces the file by what fill(input, temporary) writes; the input has a provenance then.
template <class Fill>
Status replaced(const ExportInput& input, const Path& path, Fill fill) {
    const Provenance nobody;
    ExportInput complete = input;
    if (!complete.provenance) complete.provenance = &nobody;
    try {
        return replaceFile(path, [&](const Path& temporary) { return fill(complete, temporary); });
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, fmt::format("cannot write '{}': out of memory", path.string())};
    } catch (const std::exception& e) {
        return writeError(path, e.what());
    }
}

}  // namespace

Status checkOptions(const Exporter& row, const ExportOptions& options) {
    for (const auto& [name, value] : options) {
        const auto known = std::find_if(row.options.begin(), row.options.end(),
                                        [&name = name](const ExportOption& o) { return o.name == name; });
        if (known == row.options.end())
            return Error{Error::Kind::Usage,
                         fmt::format("{} has no option '{}'; it has: {}", row.extension, name,
                                     joined(row.options, ", ", [](const ExportOption& o) { return o.name; }))};
        if (const std::string why = refusal(*known, value); !why.empty())
            return Error{Error::Kind::Usage, fmt::format("option '{}' of {} {}", name, row.extension, why)};
    }
    return Done{};
}

std::span<const Exporter> exporters() { return table; }

bool holdsColliders(const Exporter& row) {
    return std::any_of(row.options.begin(), row.options.end(),
                       [](const ExportOption& o) { return o.name == "engine"; });
}

bool takesBare(const Exporter& row, const ExportOptions& options) { return row.takesBare && row.takesBare(options); }

const Exporter* findExporter(std::string_view extension) {
    const std::string lower = lowered(std::string(extension));
    const auto row =
        std::find_if(std::begin(table), std::end(table), [&](const Exporter& e) { return e.extension == lower; });
    return row == std::end(table) ? nullptr : row;
}

const Exporter* exporterFor(const Path& path) {
    const std::string name = lowered(path.filename().string());
    const auto row = std::find_if(std::begin(table), std::end(table), [&](const Exporter& e) {
        return name.size() > e.extension.size() && name.ends_with(e.extension);
    });
    return row == std::end(table) ? nullptr : row;
}

std::vector<Path> filesOf(const Path& path) {
    const Exporter* const row = exporterFor(path);
    return row && row->write == writeObj ? std::vector{path, materialFile(path)} : std::vector{path};
}

Status write(const ExportInput& input, const Path& path) {
    const auto row = rowFor(path);
    if (!row.ok()) return row.error();
    if (Status status = checkInput(input, **row, path); !status.ok()) return status;
    return replaced(input, path, [&](const ExportInput& complete, const Path& temporary) {
        return (*row)->write(complete, temporary, path);
    });
}

Status writeStreamed(const ExportInput& input, const ChunkSource& chunks, const Path& path) {
    const auto row = rowFor(path);
    if (!row.ok()) return row.error();
    if (!(*row)->stream)
        return Error{Error::Kind::Usage, fmt::format("{} wants the whole mesh; chunk by chunk there are {}",
                                                     (*row)->extension, streamedExtensions())};
    if (Status status = checkOptions(**row, input.options); !status.ok()) return status;
    return replaced(input, path, [&](const ExportInput& complete, const Path& temporary) -> Status {
        uint64_t triangles = 0;
        const bool whole = !takesBare(**row, input.options);
        const ChunkSource counted = [&](const mesh::ChunkVisitor& visit) {
            return chunks([&](const mesh::Mesh& window, const mesh::Chunk& chunk) -> Status {
                triangles += chunk.triangles.size();
                if (whole && chunk.isBare()) return bareError(path);
                return visit(window, chunk);
            });
        };
        if (Status status = (*row)->stream(complete, counted, temporary, path); !status.ok()) return status;
        if (triangles == 0) return writeError(path, "the mesh has no triangles");
        return Done{};
    });
}

std::string leveledExtensions() {
    std::vector<std::string_view> extensions;
    for (const Exporter& e : table)
        if (e.holdsLevels) extensions.push_back(e.extension);
    return joined(extensions, " ", [](std::string_view e) { return e; });
}

std::string streamedExtensions() {
    std::vector<std::string_view> extensions;
    for (const Exporter& e : table)
        if (e.stream) extensions.push_back(e.extension);
    return joined(extensions, " ", [](std::string_view e) { return e; });
}

}  // namespace sgm::exporter
