// The program `sgm-viewer`: one window about one document.
// Enters: a file and what is asked of the window. Leaves: an exit code. Assumes the main thread.
#pragma once

#include <filesystem>

#include "viewer/window/orbit.h"

namespace sgm::window {

struct AppOptions {
    std::filesystem::path file;    ///< empty for a new document
    std::filesystem::path report;  ///< empty, or the JSON that tells tests where the widgets are
    int width = 1280, height = 800;
    bool benchmark = false;  ///< measures, prints and closes
};

/// Runs until the window is closed. Prints errors to stderr; 0 or 1.
int runApp(const AppOptions& options);

}  // namespace sgm::window
