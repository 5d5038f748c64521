#include "cli/renamed.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/messages.h"

namespace sgm::cli {
namespace {

constexpr const char* unlisted = "";  ///< CLI11's group of options that --help leaves out

}  // namespace

void noteRenamed(const char* oldName, const char* newName) {
    printMessage("note: {} is now {}; the old name goes with the next version\n", oldName, newName);
}

void addRenamedOption(CLI::App& command, const char* oldName, const char* newName, std::vector<std::string>& values) {
    command
        .add_option_function<std::vector<std::string>>(oldName,
                                                       [=, &values](const std::vector<std::string>& given) {
                                                           noteRenamed(oldName, newName);
                                                           values.insert(values.end(), given.begin(), given.end());
                                                       })
        ->allow_extra_args(false)
        ->group(unlisted);
}

void addRenamedFlag(CLI::App& command, const char* oldName, const char* newName, bool& value) {
    command
        .add_flag_callback(oldName,
                           [=, &value] {
                               noteRenamed(oldName, newName);
                               value = true;
                           })
        ->group(unlisted);
}

}  // namespace sgm::cli
