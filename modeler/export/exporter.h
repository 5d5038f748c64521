// The exporter table: one row a format.
// Enters: a mesh (or a volume) with its provenance. Leaves: a file, written beside its target and renamed into place,
// so that a good earlier file is never lost. Assumes metres, Y up; options say otherwise for formats that can't.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"
#include "modeler/volume/volume.h"

namespace sgm::exporter {

/// One option of a format, for the export dialog and the reference page.
struct ExportOption {
    std::string_view name;
    std::string_view fallback;
    std::string_view choices;  ///< "y|z", or "" for free text
    std::string_view doc;
};

/// What is written. `mesh` is set for mesh formats, `volume` for volumes.
struct ExportInput {
    const mesh::Mesh* mesh = nullptr;
    const volume::Volume* volume = nullptr;
    const Provenance* provenance = nullptr;
    std::string name = "model";                 ///< of the object in the file
    std::map<std::string, std::string> extras;  ///< grammar, seed, parameters: kept where the format can hold them
    std::map<std::string, std::string, std::less<>> options;  ///< by ExportOption::name
    Progress* progress = nullptr;
};

struct Exporter {
    std::string_view extension;  ///< ".glb"
    std::string_view doc;
    bool wantsVolume;
    std::span<const ExportOption> options;
    /// Writes to `temporary`; `write` renames it into place.
    Status (*write)(const ExportInput& input, const std::filesystem::path& temporary,
                    const std::filesystem::path& target);
};

/// The table, in the order of docs/reference.md.
std::span<const Exporter> exporters();
/// The row for ".glb" …, or null.
const Exporter* findExporter(std::string_view extension);
/// Writes `path` by its extension: all or nothing, Error::Cancelled when `input.progress` says so.
Status write(const ExportInput& input, const std::filesystem::path& path);

}  // namespace sgm::exporter
