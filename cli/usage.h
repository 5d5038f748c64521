// Wrong usage of the program, with the command or option that was meant.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace sgm::cli {

/// What is wrong with the words after the program's name, where a word is no command, or an option isn't one of the
/// command's: with the nearest name, or the command that has it. Empty for any other mistake.
std::string usageProblem(const CLI::App& app, int argc, const char* const* argv);

}  // namespace sgm::cli
