// The widgets of the panels: ImGui's, marked in the report under a name.
// Enters: a report and a name such as "bar.save". Leaves: what was pressed. Assumes a frame of ImGui.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "viewer/document/word_lists.h"
#include "viewer/window/report.h"

namespace sgm::window::widgets {

/// A button; `hint` explains it while the pointer rests on it.
bool button(Report& report, const std::string& name, const char* label, const char* hint = nullptr,
            bool enabled = true);
/// A button that is only its text.
bool quietButton(Report& report, const std::string& name, const char* label, const char* hint = nullptr,
                 bool enabled = true);
/// One of several, side by side, each explained by its hint where there are any. True when another was chosen.
bool oneOf(Report& report, const std::string& name, std::span<const char* const> labels, int& value,
           std::span<const char* const> hints = {});
bool toggle(Report& report, const std::string& name, const char* label, bool& value, const char* hint = nullptr);
/// A combo box of `width` pixels (0: what is left). Its items are reported as NAME.ITEM while it is open.
bool choice(Report& report, const std::string& name, std::span<const std::string> items, int& value, float width = 0);
/// A button that opens the words in their groups, those of a group side by side, each explained while the pointer rests
/// on it; they are reported as NAME.WORD while it is open. True when one was picked.
bool pick(Report& report, const std::string& name, const char* label,
          const std::function<std::vector<document::ListedWord>()>& words, std::string& picked);
/// How wide a button with this label is, pixels.
float buttonWidth(const char* label);
/// A line of text; true when it was ended with Enter or left, changed.
bool field(Report& report, const std::string& name, std::string& text, const char* hint = nullptr, float width = 0);
/// Enter was pressed in the field just made: it presses the button that belongs to the field.
bool entered();
/// A line of text, and the button behind it that takes what stands in it.
struct FieldWithButton {
    std::string field;                 ///< the field's name in the report
    const char* empty = nullptr;       ///< what stands in it while it is empty
    const char* fieldHint = nullptr;   ///< what explains the field
    std::string button;                ///< the button's name in the report
    const char* label = "";            ///< the button's
    const char* buttonHint = nullptr;  ///< what explains the button
    bool isCode = false;               ///< the field takes a piece of a grammar
};
/// Both, as wide as the panel. True when the button was pressed, or Enter in the field, while `possible`, which is
/// asked behind the field.
bool fieldWithButton(Report& report, const FieldWithButton& row, std::string& text,
                     const std::function<bool()>& possible = {});
/// A heading within a panel.
void heading(const char* text);
/// The text, its end replaced by "…" where it is wider than `width` pixels.
std::string shortened(const std::string& text, float width);
/// `text` in the faint colour.
void faint(const std::string& text);
/// Explains the widget just made while the pointer rests on it.
void hint(const char* text);
/// A tip at the pointer, its lines wrapped.
void tooltip(const char* text);

}  // namespace sgm::window::widgets
