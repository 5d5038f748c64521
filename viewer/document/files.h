// Reading grammar files, and finding what `use` names.
// Enters: paths. Leaves: sources. Assumes that only cli/ and viewer/ read the disk.
#pragma once

#include <filesystem>

#include "grammar/rules/check.h"
#include "modeler/core/result.h"

namespace sgm::viewer {

/// The file's text as a source named as the user wrote it; Error::Input when it can't be read.
Result<syntax::SourcePtr> readSource(const std::filesystem::path& path);

/// Finds "std/…" in the standard library shipped with the program and other names beside the file that uses them;
/// refuses names that lead outside these two folders. A loader reads a mesh again only when its file has changed.
rules::Loader fileLoader();

/// Writes text beside `path` and renames it into place.
Status writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace sgm::viewer
