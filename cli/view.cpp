// sgm view: the window about a grammar, which is the program sgm-viewer beside this one.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "cli/commands.h"
#include "cli/requests.h"
#include "modeler/core/packages.h"

namespace sgm::cli {
namespace {

/// Becomes the other program; comes back only where that can't be.
int become(std::vector<std::string> words) {
    if (!isBuiltWith(Package::Window)) return fail(missingPackage(Package::Window, "view"));
    std::error_code ignored;
    const std::filesystem::path beside =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "sgm-viewer";
    words.insert(words.begin(), beside.string());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(beside.c_str(), arguments.data());
    fmt::print(stderr, "sgm: can't start '{}': {}\n", beside.string(), std::strerror(errno));
    return 1;
}

}  // namespace

void addView(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("view", "Open the window: see the model at once, change it by hand");
    command->prefix_command();
    command->fallthrough(false);  // what follows is no argument of sgm
    command->footer(
        "All that follows goes to sgm-viewer; see sgm-viewer --help.\nExample:\n  sgm view examples/grotto.sgm");
    command->callback([command, &exitCode] { exitCode = become(command->remaining()); });
}

}  // namespace sgm::cli
