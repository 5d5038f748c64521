// From text to a checked grammar, with the standard library and the files beside it.
// Enters: a file or its text. Leaves: a Grammar, diagnostics. Assumes nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "grammar/rules/check.h"
#include "modeler/core/progress.h"

namespace sgm::pipeline {

/// The grammar that `text` says; `name` is what diagnostics call it, and its folder is where `use` and files are looked
/// for. Null where `diagnostics` has errors. Reading large files ends early when `progress` says so.
std::shared_ptr<const rules::Grammar> load(const std::filesystem::path& name, std::string text,
                                           syntax::Diagnostics& diagnostics, const Progress* progress = nullptr);

/// The grammar of a file; Error::Input where it can't be read. Null where `diagnostics` has errors.
Result<std::shared_ptr<const rules::Grammar>> loadFile(const std::filesystem::path& path,
                                                       syntax::Diagnostics& diagnostics,
                                                       const Progress* progress = nullptr);

}  // namespace sgm::pipeline
