// The line above a text that finds words in it.
// Enters: a text and the word that is sought. Leaves: an editor with the next place selected. Assumes a frame of ImGui.
#pragma once

#include <string>

#include "viewer/window/code_editor.h"

namespace sgm::window {

class TextSearch {
public:
    /// Shows the line, when it is open, and goes on to the next or previous place as the user asks. True when the user
    /// has closed it.
    bool show(Report& report, const std::string& text, CodeEditor& editor);
    /// Opens it where `Ctrl+F` is pressed; F3 goes on even while the line is closed. Call while the text is in front
    /// and no field takes keys.
    void keys(const std::string& text, CodeEditor& editor);

private:
    void go(const std::string& text, CodeEditor& editor, bool backward);

    bool open_ = false, enter_ = false, missing_ = false;
    std::string word_;
};

}  // namespace sgm::window
