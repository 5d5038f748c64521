// A text that is edited: line numbers, syntax colours, notes under their lines.
// Enters: a text with its colours and notes. Leaves: the text after a key. Assumes UTF-8 and a frame of ImGui; history
// and file belong to whoever owns the text.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

#include "viewer/document/colours.h"
#include "viewer/document/line_edits.h"
#include "viewer/window/report.h"

namespace sgm::window {

/// A sentence under a line, and what of the line it is about.
struct LineNote {
    uint32_t line = 0;            ///< from 0
    uint32_t begin = 0, end = 0;  ///< bytes of the line, underlined; may be empty
    std::string text;
    ImU32 color = 0;
};

class CodeEditor {
public:
    /// Fills the rest of the window. The text after what was typed, or nothing where it stays. `colors` are of this
    /// very text, a list a line.
    std::optional<std::string> show(Report& report, const std::string& text,
                                    const std::vector<std::vector<document::Coloured>>& colors,
                                    const std::vector<LineNote>& notes);
    /// Selects bytes [begin, end) and scrolls there.
    void reveal(uint32_t begin, uint32_t end);
    /// It takes keys.
    bool active() const { return active_; }
    void leave() { active_ = false; }
    /// Takes keys from now on.
    void enter() { active_ = true; }
    uint32_t caret() const { return caret_; }
    /// The bytes that are selected; empty where the caret stands alone.
    std::pair<uint32_t, uint32_t> selection() const { return std::minmax(caret_, anchor_); }
    /// How far it is scrolled sideways, pixels.
    float scrolled() const { return scrolled_; }
    /// The pointer put the caret somewhere in the last `show`.
    bool clicked() const { return clicked_; }

private:
    struct Row {
        uint32_t line;
        int note;  ///< −1: the line itself
    };
    void layOut(const std::string& text, const std::vector<LineNote>& notes);
    void drawLine(const std::string& text, uint32_t line, const std::vector<document::Coloured>& colors,
                  const std::vector<LineNote>& notes, ImVec2 low);
    void mouse(const std::string& text, ImVec2 origin);
    std::optional<std::string> keys(const std::string& text);
    void moveBy(const std::string& text);
    /// The text after an edit of its lines.
    std::string taken(document::EditedText edited);
    /// Scrolls both ways to what `follow_` says.
    void follow(const std::string& text);
    /// Its row; all of it while the pointer rests there.
    void drawNote(const LineNote& note, ImVec2 low);
    std::string replaced(const std::string& text, uint32_t begin, uint32_t end, const std::string& by);
    float xOf(const std::string& text, uint32_t line, uint32_t offset) const;
    uint32_t offsetAt(const std::string& text, uint32_t line, float x) const;
    uint32_t lineOf(uint32_t offset) const;
    uint32_t endOf(const std::string& text, uint32_t line) const;
    uint32_t caret_ = 0, anchor_ = 0;  ///< bytes; equal without a selection
    float wantedX_ = -1;               ///< where a caret that moves up and down would stand
    bool active_ = false, clicked_ = false;
    /// What is to be seen.
    enum class Follow { No, Caret, Selection } follow_ = Follow::No;
    std::vector<uint32_t> starts_;  ///< of lines
    std::vector<Row> rows_;
    std::vector<uint32_t> rowOf_;  ///< by line
    float gutter_ = 0, height_ = 0, scrolled_ = 0;
};

}  // namespace sgm::window
