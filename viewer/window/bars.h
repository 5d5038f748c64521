// The bar at the top with what concerns all of the window, the line at the bottom, and the keys of both.
// Enters: the workbench. Leaves: its verbs called. Assumes a frame of ImGui.
#pragma once

#include "viewer/window/dialogs.h"
#include "viewer/window/workbench.h"

namespace sgm::window {

class Bars {
public:
    void top(Workbench& bench);
    /// Height of what `top` shows, pixels: two lines where the window is too narrow for one.
    float height() const;
    void status(Workbench& bench);
    /// Open, save, undo, help, pictures. Call once a frame, when no text takes keys.
    void keys(Workbench& bench);
    /// What stands over the window: the cheat sheet, a file to open, a question. Call once a frame, outside windows.
    void dialogs(Workbench& bench);

private:
    void lookControls(Workbench& bench);
    void meshControls(Workbench& bench);
    void cheatSheet(Workbench& bench);

    bool help_ = false;
    bool wrapped_ = false;  ///< the mesh's controls have a line of their own
    Dialogs dialogs_;
};

}  // namespace sgm::window
