// The rows of the exporter table, one .cpp each, and the few things they share.
// Enters: what `write` has checked: a mesh with triangles (or a level set), a provenance, known options with known
// values. Leaves: the temporary file filled. `target` is for messages and for files that lie beside.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modeler/export/exporter.h"

namespace sgm::exporter {

using Path = std::filesystem::path;

// clang-format off
/// Every format, in the order of the reference page; each is defined in a file of its own.
#define SGM_FORMATS(X) X(glb) X(gltf) X(obj) X(ply) X(stl) X(off) X(usda) X(vdb) X(csgJson) X(scad) X(svg) X(geojson) X(html)
// clang-format on
#define SGM_DECLARE(name) extern const Exporter name##Format;
SGM_FORMATS(SGM_DECLARE)
#undef SGM_DECLARE

/// Options that several formats have.
inline constexpr ExportOption uvOption{
    "uv", "scope", "scope|box|none",
    "texture coordinates in metres: in the plane of each face, turned with the scope of its shape, "
    "or projected along the nearest axis"};
inline constexpr ExportOption lightMapOption{
    "lightmap", "none", "none|256|512|1024|2048|4096",
    "a second set of texture coordinates, without overlaps, for a light map of so many texels a side for each object"};
inline constexpr ExportOption upOption{"up", "y", "y|z", "the axis that points up in the file"};
inline constexpr ExportOption unitOption{"unit", "m", "m|cm|mm", "the length of one unit in the file"};
/// `instances`, "yes" or "no" where nothing is said.
constexpr ExportOption instancesOption(std::string_view fallback) {
    return {"instances", fallback, "yes|no", "whether objects that are equal and touch nothing show one surface"};
}
/// Exporter::takesPositionsOnly of formats that never say anything of normals and origins.
inline bool saysPositionsOnly(const ExportOptions&) { return true; }

/// The value of a checked option, or `fallback` where it isn't given.
std::string_view option(const ExportInput& input, std::string_view name, std::string_view fallback);

/// `text` as a number, where all of it is a finite one.
std::optional<double> numberOf(std::string_view text);

/// The axes and unit of a file, by the options `up` and `unit`.
struct Placement {
    bool zUp = false;
    float unitsPerMetre = 1;

    /// Files hold what the mesh does.
    bool isIdentity() const { return !zUp && unitsPerMetre == 1; }
    /// Turned by 90° about x where the file's z is up.
    Vec3f direction(Vec3f d) const { return zUp ? Vec3f{d.x, -d.z, d.y} : d; }
    Vec3f position(Vec3f p) const { return direction(p) * unitsPerMetre; }
};
Placement placementOf(const ExportInput& input);

/// Valid UTF-8: bytes that are none become U+FFFD.
std::string validUtf8(const std::string& text);
/// `text` on one line, for comments: control characters become spaces.
std::string oneLine(std::string text);
/// A name a line of text can hold as one word: white space, control characters, quotes and '#' become '_'.
std::string wordOf(std::string name);
/// How a file in `folder` names another one, with '/': the way to it, or all of it where there is none.
std::string pathFrom(const std::filesystem::path& folder, const std::filesystem::path& file);
/// The material library beside an OBJ file.
Path materialFile(const Path& target);
/// A letter or '_' followed by letters, digits and '_': what USD calls an identifier.
std::string identifierOf(std::string name);
/// The materials' names, each turned by `turn`, equal ones told apart by "_2", "_3", … in order.
std::vector<std::string> distinctNames(const std::vector<Material>& materials, std::string (*turn)(std::string));

}  // namespace sgm::exporter
