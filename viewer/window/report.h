// What a test or another program may know of the window: where each widget is, and the state.
// Enters: marks behind widgets, values. Leaves: a JSON file after every frame (`sgm-viewer --report FILE`). Assumes a
// frame of ImGui; without a file it costs nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

#include "viewer/window/elapsed.h"

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
    /// A turn of the window's loop between two looks at the user's input, without the wait for events.
    void add(const FrameTimeline& turn);
    /// Writes {"frame": n, "widgets": {name: [x, y, width, height]}, "state": {…}, "gaps": {…}} beside the file and
    /// renames it there. `gaps` is of all turns since the start: how many; and with drawing excluded and included, by
    /// the wall's clock and by the processor's for this thread, how many of them took more than 50 ms, which part took
    /// most of each of these, and the longest in seconds, with the frame before it and its parts.
    void write();

private:
    struct Data;
    std::filesystem::path file_;
    std::unique_ptr<Data> data_;
};

}  // namespace sgm::window
