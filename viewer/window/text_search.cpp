#include "viewer/window/text_search.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "viewer/document/line_edits.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {

void TextSearch::go(const std::string& text, CodeEditor& editor, bool backward) {
    const auto [from, to] = editor.selection();
    const auto found = document::occurrence(text, word_, backward ? from : to, backward);
    missing_ = !found && !word_.empty();
    if (found) editor.reveal(found->first, found->second);
}

void TextSearch::keys(const std::string& text, CodeEditor& editor) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsKeyPressed(GLFW_KEY_F3)) go(text, editor, io.KeyShift);
    if (!io.KeyCtrl || !ImGui::IsKeyPressed(GLFW_KEY_F, false)) return;
    open_ = enter_ = true;
    missing_ = false;
    editor.leave();
    const auto [from, to] = editor.selection();
    const std::string selected = text.substr(std::min<size_t>(from, text.size()), to - from);
    if (!selected.empty() && selected.find('\n') == std::string::npos) word_ = selected;
}

bool TextSearch::show(Report& report, const std::string& text, CodeEditor& editor) {
    if (!open_) return false;
    const ImGuiStyle& style = ImGui::GetStyle();
    float buttons = 0;
    for (const char* label : {"Previous", "Next", "Close"})
        buttons += ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
    if (std::exchange(enter_, false)) ImGui::SetKeyboardFocusHere();
    if (missing_) ImGui::PushStyleColor(ImGuiCol_Text, tint::error);
    widgets::field(report, "search.word", word_, "Find in the text", ImGui::GetContentRegionAvail().x - buttons);
    if (missing_) ImGui::PopStyleColor();
    const bool active = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    if (ImGui::IsItemEdited()) missing_ = false;
    const bool back = ImGui::GetIO().KeyShift;
    if (widgets::entered()) {
        go(text, editor, back);
        enter_ = true;  // the next Enter goes on
    } else if (active && ImGui::IsKeyPressed(GLFW_KEY_F3)) {
        go(text, editor, back);
    }
    const bool escaped = active && ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
    ImGui::SameLine();
    if (widgets::button(report, "search.previous", "Previous", "Shift+Enter, Shift+F3")) go(text, editor, true);
    ImGui::SameLine();
    if (widgets::button(report, "search.next", "Next", "Enter, F3")) go(text, editor, false);
    ImGui::SameLine();
    open_ = !widgets::button(report, "search.close", "Close", "Esc") && !escaped;
    return !open_;
}

}  // namespace sgm::window
