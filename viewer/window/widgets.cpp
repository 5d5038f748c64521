#include "viewer/window/widgets.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "viewer/window/style.h"

namespace sgm::window::widgets {

void hint(const char* text) {
    if (text && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) tooltip(text);
}

void tooltip(const char* text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool button(Report& report, const std::string& name, const char* label, const char* text, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    ImGui::PushID(name.c_str());
    const bool pressed = ImGui::Button(label);
    ImGui::PopID();
    ImGui::EndDisabled();
    report.mark(name);
    hint(text);
    return pressed;
}

bool quietButton(Report& report, const std::string& name, const char* label, const char* text, bool enabled) {
    ImGui::PushStyleColor(ImGuiCol_Button, 0);
    const bool pressed = button(report, name, label, text, enabled);
    ImGui::PopStyleColor();
    return pressed;
}

bool oneOf(Report& report, const std::string& name, std::span<const char* const> labels, int& value,
           std::span<const char* const> hints) {
    const int before = value;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(1, ImGui::GetStyle().ItemSpacing.y));
    for (int i = 0; i < static_cast<int>(labels.size()); ++i) {
        if (i > 0) ImGui::SameLine();
        if (i == before) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
        const bool pressed = button(report, name + "." + labels[size_t(i)], labels[size_t(i)],
                                    hints.empty() ? nullptr : hints[size_t(i)]);
        if (i == before) ImGui::PopStyleColor();
        if (pressed) value = i;
    }
    ImGui::PopStyleVar();
    return value != before;
}

bool toggle(Report& report, const std::string& name, const char* label, bool& value, const char* text) {
    ImGui::PushID(name.c_str());
    const bool changed = ImGui::Checkbox(label, &value);
    ImGui::PopID();
    report.mark(name);
    hint(text);
    return changed;
}

bool choice(Report& report, const std::string& name, std::span<const std::string> items, int& value, float width) {
    bool changed = false;
    const bool known = value >= 0 && value < static_cast<int>(items.size());
    ImGui::SetNextItemWidth(width > 0 ? width : -FLT_MIN);
    ImGui::PushID(name.c_str());
    const bool open =
        ImGui::BeginCombo("##choice", known ? items[size_t(value)].c_str() : "", ImGuiComboFlags_HeightLargest);
    if (!open) report.mark(name);
    if (open) {
        for (int i = 0; i < static_cast<int>(items.size()); ++i) {
            ImGui::PushID(i);
            if (ImGui::Selectable(items[size_t(i)].c_str(), i == value) && i != value) {
                value = i;
                changed = true;
            }
            report.mark(name + "." + items[size_t(i)]);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
    return changed;
}

bool pick(Report& report, const std::string& name, const char* label,
          const std::function<std::vector<document::ListedWord>()>& words, std::string& picked) {
    ImGui::PushID(name.c_str());
    const bool opens = ImGui::Button(label);
    if (!ImGui::IsPopupOpen("words")) report.mark(name);
    if (opens) ImGui::OpenPopup("words");
    bool chosen = false;
    if (ImGui::BeginPopup("words")) {
        const float width = ImGui::GetFontSize() * 24, left = ImGui::GetCursorScreenPos().x;
        std::string group;
        for (const document::ListedWord& word : words()) {
            const float needed = ImGui::CalcTextSize(word.name.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
            if (word.group != group) {
                if (!group.empty()) ImGui::NewLine();
                faint(group = word.group);
            } else if (ImGui::GetCursorScreenPos().x + needed > left + width) {
                ImGui::NewLine();
            }
            if (quietButton(report, name + "." + word.name, word.name.c_str(),
                            word.doc.empty() ? nullptr : word.doc.c_str())) {
                picked = word.name;
                chosen = true;
                ImGui::CloseCurrentPopup();
            }
            ImGui::SameLine(0, 0);
        }
        ImGui::EndPopup();
    }
    ImGui::PopID();
    return chosen;
}

float buttonWidth(const char* label) { return ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x; }

bool field(Report& report, const std::string& name, std::string& text, const char* empty, float width) {
    ImGui::SetNextItemWidth(width > 0 ? width : -FLT_MIN);
    ImGui::PushID(name.c_str());
    ImGui::InputTextWithHint("##field", empty ? empty : "", &text, ImGuiInputTextFlags_AutoSelectAll);
    const bool changed = ImGui::IsItemDeactivatedAfterEdit();
    ImGui::PopID();
    report.mark(name);
    return changed;
}

bool entered() {
    return ImGui::IsItemDeactivated() &&
           (ImGui::IsKeyPressed(GLFW_KEY_ENTER, false) || ImGui::IsKeyPressed(GLFW_KEY_KP_ENTER, false));
}

bool fieldWithButton(Report& report, const FieldWithButton& row, std::string& text,
                     const std::function<bool()>& possible) {
    const float width = ImGui::GetContentRegionAvail().x - buttonWidth(row.label) - ImGui::GetStyle().ItemSpacing.x;
    if (row.isCode) ImGui::PushFont(codeFont());
    field(report, row.field, text, row.empty, width);
    if (row.isCode) ImGui::PopFont();
    const bool done = entered();
    hint(row.fieldHint);
    ImGui::SameLine();
    const bool isPossible = !possible || possible();
    return button(report, row.button, row.label, row.buttonHint, isPossible) || (done && isPossible);
}

void heading(const char* text) {
    ImGui::Dummy(ImVec2(0, 2));
    ImGui::PushFont(strongFont());
    ImGui::TextUnformatted(text);
    ImGui::PopFont();
}

std::string shortened(const std::string& text, float width) {
    ImFont* const font = ImGui::GetFont();
    const float size = ImGui::GetFontSize();
    const char *const begin = text.c_str(), *const end = begin + text.size(), *rest = begin;
    font->CalcTextSizeA(size, width, 0, begin, end, &rest);  // looks no farther than the width
    if (rest == end) return text;
    const char* kept = begin;
    font->CalcTextSizeA(size, width - ImGui::CalcTextSize("…").x, 0, begin, rest, &kept);
    while (kept > begin && kept[-1] == ' ') --kept;
    return std::string(begin, kept) + "…";
}

void faint(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, tint::faint);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

}  // namespace sgm::window::widgets
