// All-or-nothing files: what stood at the target stays until the new content is complete and on the disk.
// Enters: a target path and a function that fills a temporary file. Leaves: the target replaced, or untouched and an
// Error. Assumes POSIX: rename(2) within one folder is atomic.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "modeler/core/result.h"

namespace sgm {

/// Makes an empty file beside `target`, lets `fill` write it, flushes it to disk and renames it over `target`, keeping
/// the permissions of a file that stood there. A symbolic link is followed. On any failure the temporary is removed and
/// the target is as it was; Error::Input names the path and the cause. A killed process leaves at most the temporary
/// (".sgm-<pid>-<n>.tmp"), which the next one that writes into the folder removes once it is a minute old.
Status replaceFile(const std::filesystem::path& target,
                   const std::function<Status(const std::filesystem::path& temporary)>& fill);

/// Replaces `path` by a file of these bytes, with replaceFile().
Status writeFile(const std::filesystem::path& path, std::string_view bytes);

/// Whether `replaceFile` could begin: the folder is there and can be written, and what stands at `target` is a regular
/// file or nothing. The error is that of `replaceFile`.
Status checkTarget(const std::filesystem::path& target);

/// A text that is equal for two paths to the same file, whatever their spelling and the links on the way; of a file
/// that isn't there yet, by the place where `replaceFile` would make it.
std::string identityOf(const std::filesystem::path& path);

/// "cannot write 'path': cause", the form of every file error here.
Error writeError(const std::filesystem::path& path, const std::string& cause);
/// The same, with the cause of a system error number.
Error writeError(const std::filesystem::path& path, int errorNumber);

}  // namespace sgm
