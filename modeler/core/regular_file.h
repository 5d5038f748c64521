// Files from outside, read whole.
// Enters: a path that somebody else may have chosen. Leaves: the file's bytes. Assumes POSIX. Never waits: pipes,
// devices and folders are refused before a byte of them is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "modeler/core/progress.h"

namespace sgm {

/// Reads all of a regular file, at most `most_bytes`. The error is the cause alone ("No such file or directory", "it is
/// a pipe, not a file"), for the caller to name the file; Error::Cancelled when `progress` says so.
Result<std::string> readRegularFile(const std::filesystem::path& path, uint64_t most_bytes,
                                    const Progress* progress = nullptr);

}  // namespace sgm
