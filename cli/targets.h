// Where files are to be written, looked at before the work.
// Enters: the names a user gave. Leaves: an error, or the certainty that no file replaces one that is read or another
// of the same run. Assumes that nobody moves files meanwhile.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "modeler/core/result.h"

namespace sgm::cli {

/// A file that a command will write.
struct Target {
    std::string option;  ///< "-o", "--report" …, as the user gave it
    std::filesystem::path file;
};

/// Error::Input where a target is a folder, a pipe or a device, or its folder is missing or can't be written;
/// Error::Usage where two are the same file by whatever spelling, or one is another's material library.
Status checkTargets(const std::vector<Target>& targets);

/// Error::Usage where a target is one of `inputs`.
Status checkAgainstInputs(const std::vector<Target>& targets, const std::vector<std::filesystem::path>& inputs);

}  // namespace sgm::cli
