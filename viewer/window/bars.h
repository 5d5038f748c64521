// The bar at the top with what concerns all of the window, the line at the bottom, and the keys of both.
// Enters: the workbench. Leaves: its verbs called. Assumes a frame of ImGui.
#pragma once

#include "viewer/window/dialogs.h"
#include "viewer/window/workbench.h"

namespace sgm::window {

class Bars {
public:
    void top(Workbench& bench);
    /// Height of what `top` showed last, pixels: more lines where the window is too narrow for one.
    float height() const;
    void status(Workbench& bench);
    /// A command about the document ends the field that takes keys, so that what was typed there counts. Call at the
    /// start of a frame, before the fields.
    void leaveField(Workbench& bench);
    /// Whether keys mean commands: no dialog and no field takes them, or `leaveField` has just ended one.
    bool takesKeys(const Workbench& bench) const;
    /// Open, save, undo, help, pictures. Call once a frame where `takesKeys`.
    void keys(Workbench& bench);
    /// What stands over the window: the cheat sheet, a file to open, a question. Call once a frame, outside windows.
    void dialogs(Workbench& bench);

private:
    /// Goes on behind the last widget, or in a new line where no `width` pixels are left.
    void flow(float width, float space = -1);
    /// The same with a line between two groups.
    void flowApart(float width);
    void lookControls(Workbench& bench);
    void meshControls(Workbench& bench);
    void save(Workbench& bench);
    void cheatSheet(Workbench& bench);

    bool help_ = false;
    bool leftField_ = false;  ///< in this frame
    int lines_ = 1;           ///< of `top`
    Dialogs dialogs_;
};

}  // namespace sgm::window
