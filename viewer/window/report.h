// What a test or another program may know of the window: where each widget is, and the state.
// Enters: marks behind widgets, values. Leaves: a JSON file after every frame (`sgm-viewer --report FILE`). Assumes a
// frame of ImGui; without a file it costs nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

namespace sgm::window {

class Report {
public:
    /// An empty path reports nothing.
    explicit Report(std::filesystem::path file);
    ~Report();
    bool active() const { return !file_.empty(); }
    /// The widget just made is called `name`; it is reported while it can be seen.
    void mark(const std::string& name);
    /// The same for a rectangle of the screen.
    void mark(const std::string& name, ImVec2 low, ImVec2 high);
    /// Values of this frame, a member each.
    nlohmann::json& state();
    /// Writes {"frame": n, "widgets": {name: [x, y, width, height]}, "state": {…}} beside the file and renames it
    /// there.
    void write();

private:
    struct Data;
    std::filesystem::path file_;
    std::unique_ptr<Data> data_;
};

}  // namespace sgm::window
