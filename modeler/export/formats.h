// The writers behind the exporter table, one .cpp each.
// Enters: what `write` has checked: a mesh with triangles (or a volume), known options with known values. Leaves: the
// temporary file filled. Assumes provenance is set. `target` is for messages and for files that lie beside.
#pragma once

#include "modeler/export/exporter.h"

namespace sgm::exporter {

using Path = std::filesystem::path;

Status writeGlb(const ExportInput& input, const Path& temporary, const Path& target);
Status writeGltf(const ExportInput& input, const Path& temporary, const Path& target);

/// The value of a checked option, or `fallback` where it isn't given.
std::string_view option(const ExportInput& input, std::string_view name, std::string_view fallback);
/// Valid UTF-8: bytes that are none become U+FFFD.
std::string validUtf8(const std::string& text);
/// What a writer returns when `progress` was cancelled.
Error cancelledError();

}  // namespace sgm::exporter
