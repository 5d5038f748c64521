// Old names of options, which go on working for one version and say what replaces them.
// Enters: a command and where an option's value goes. Leaves: the old name beside the new one, not listed by --help.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sgm::cli {

/// Prints to stderr that an option has a new name.
void noteRenamed(const char* oldName, const char* newName);

/// Adds `oldName`, whose values are appended to those of the option that was renamed; call it after adding that one.
void addRenamedOption(CLI::App& command, const char* oldName, const char* newName, std::vector<std::string>& values);
/// Adds the flag `oldName`, which sets `value` as the flag that was renamed does.
void addRenamedFlag(CLI::App& command, const char* oldName, const char* newName, bool& value);

}  // namespace sgm::cli
