// Reading grammar files, and finding what `use` names.
// Enters: paths. Leaves: sources. Assumes that only cli/ and viewer/ read the disk.
#pragma once

#include <filesystem>
#include <vector>

#include "grammar/rules/check.h"
#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::pipeline {

/// The file's text as a source named as the user wrote it; Error::Input when it can't be read, is no regular file or
/// larger than 16 MiB.
Result<syntax::SourcePtr> readSource(const std::filesystem::path& path);

/// What a loader was asked for.
struct FilesRead {
    std::vector<std::filesystem::path> paths;
    bool overBudget = false;  ///< whether one was refused for its size or for the work it would take
};

/// Finds "std/…" in the standard library shipped with the program and other names beside the file that uses them;
/// refuses names that lead outside these two folders, also through links, files that aren't regular, and used files
/// that don't begin as a grammar does, without a word of what they hold. A loader and its copies share what they
/// have read, and read a mesh, map, outline or picture again only when its file has changed; one thread at a time may
/// use them. Reading ends early when `progress` says so. What is asked for is added to `read`, unless it is null; both
/// outlive the loader.
rules::Loader fileLoader(const Progress* progress = nullptr, FilesRead* read = nullptr);

/// The files of the standard library as `use` names them, "std/walls.sgm", with their texts, in the order of their
/// names.
std::vector<std::pair<std::string, syntax::SourcePtr>> standardFiles();

}  // namespace sgm::pipeline
