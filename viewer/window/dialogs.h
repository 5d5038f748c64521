// The dialogs that stand over the window: a file to open, a name to save under, a question.
// Enters: the workbench, which says what is to be asked. Leaves: its verbs called. Assumes a frame of ImGui.
#pragma once

#include <string>

#include "viewer/window/workbench.h"

namespace sgm::window {

class Dialogs {
public:
    /// Asks for a file to open.
    void open() { opening_ = true; }
    /// Call once a frame, outside windows.
    void show(Workbench& bench);

private:
    void openDialog(Workbench& bench);
    void files(Workbench& bench, const std::filesystem::path& folder, const std::string& prefix);
    void saveDialog(Workbench& bench);
    void saveUnderName(Workbench& bench, bool replacing);
    void questions(Workbench& bench);

    bool opening_ = false;
    std::string path_;      ///< typed in "Open a grammar": a folder or a file
    std::string name_;      ///< typed in "Save as"
    std::string replaces_;  ///< the name that is asked about, for a file has it
    std::string fault_;     ///< why nothing was opened or saved
};

}  // namespace sgm::window
