// The program sgm-viewer: the window about a grammar file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "viewer/window/app.h"

int main(int argc, char** argv) {
    CLI::App app{"sgm-viewer: see a grammar's model at once, change it by hand, keep the text"};
    app.set_version_flag("--version", SGM_VERSION);
    sgm::window::AppOptions options;
    std::string size = "1280x800";
    app.add_option("FILE", options.file, "Grammar file (.sgm); without one, or with a new name, a new grammar begins");
    app.add_option("--size", size, "Pixels of the window, WxH")->capture_default_str();
    app.add_option("--report", options.report,
                   "Write where the widgets are and the state, as JSON, after every frame (for tests)");
    app.add_flag("--benchmark", options.benchmark,
                 "Measure stages, drags and edits in the window, print them and close")
        ->needs("FILE");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    int used = 0;
    if (std::sscanf(size.c_str(), "%dx%d%n", &options.width, &options.height, &used) != 2 ||
        used != static_cast<int>(size.size()) || options.width < 720 || options.height < 480 || options.width > 16384 ||
        options.height > 16384) {
        fmt::print(stderr, "sgm-viewer: --size {}: write WIDTHxHEIGHT in pixels, at least 720x480\n", size);
        return 2;
    }
    try {
        return sgm::window::runApp(options);
    } catch (const std::exception& e) {
        fmt::print(stderr, "sgm-viewer: internal error: {}\n", e.what());
        return 1;
    }
}
