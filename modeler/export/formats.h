// The writers behind the exporter table, one .cpp each, and the few things they share.
// Enters: what `write` has checked: a mesh with triangles (or a level set), a provenance, known options with known
// values. Leaves: the temporary file filled. `target` is for messages and for files that lie beside.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modeler/export/exporter.h"

namespace sgm::exporter {

using Path = std::filesystem::path;

Status writeGlb(const ExportInput& input, const Path& temporary, const Path& target);
Status writeGltf(const ExportInput& input, const Path& temporary, const Path& target);
Status writeObj(const ExportInput& input, const Path& temporary, const Path& target);
Status writePly(const ExportInput& input, const Path& temporary, const Path& target);
Status writeStl(const ExportInput& input, const Path& temporary, const Path& target);
Status writeOff(const ExportInput& input, const Path& temporary, const Path& target);
Status writeUsda(const ExportInput& input, const Path& temporary, const Path& target);
Status writeVdb(const ExportInput& input, const Path& temporary, const Path& target);
Status writeCsgJson(const ExportInput& input, const Path& temporary, const Path& target);
Status writeScad(const ExportInput& input, const Path& temporary, const Path& target);
Status streamPly(const ExportInput& input, const ChunkSource& chunks, const Path& temporary, const Path& target);
Status streamStl(const ExportInput& input, const ChunkSource& chunks, const Path& temporary, const Path& target);
Status streamOff(const ExportInput& input, const ChunkSource& chunks, const Path& temporary, const Path& target);

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
/// The material library beside an OBJ file.
Path materialFile(const Path& target);
/// A letter or '_' followed by letters, digits and '_': what USD calls an identifier.
std::string identifierOf(std::string name);
/// The materials' names, each turned by `turn`, equal ones told apart by "_2", "_3", … in order.
std::vector<std::string> distinctNames(const std::vector<Material>& materials, std::string (*turn)(std::string));

}  // namespace sgm::exporter
